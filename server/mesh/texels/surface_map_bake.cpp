#include <string>

#include "mesh/parallel.h"
#include "mesh/texels/surface_bake.h"

namespace strata::mesh {

Result<void> check_map_resolution(int resolution) {
  if (resolution >= kTileSize && resolution <= 16384 && resolution % kTileSize == 0) return {};
  return fail(ErrorCode::malformed, "Invalid resolution",
              "The resolution of a surface map must be a multiple of 128 from 128 to 16384, not " +
                  std::to_string(resolution) + ".",
              "resolution");
}

Result<SurfaceMap> bake_surface_map(const Geometry& geometry, int resolution, Progress& progress,
                                    int threads) {
  STRATA_TRY(check_map_resolution(resolution));
  SurfaceMap map;
  progress.report(0, "Locating texels on the surface");
  SurfaceBake bake(geometry, resolution, map);
  using Step = void (SurfaceBake::*)(int);
  // Cancelled work is incomplete, so the map is discarded.
  const auto run = [&](Step step, double fraction_after) {
    if (progress.cancelled()) return;
    parallel_for(threads, bake.band_count(), [&](int band) {
      if (!progress.cancelled()) (bake.*step)(band);
    });
    progress.report(fraction_after, "Locating texels on the surface");
  };
  run(&SurfaceBake::mark_surface, 0.15);
  run(&SurfaceBake::mark_gutter, 0.2);
  if (!progress.cancelled()) bake.assign_slots(threads);
  run(&SurfaceBake::place_surface, 0.55);
  run(&SurfaceBake::place_gutter, 0.6);
  run(&SurfaceBake::credit_areas, 0.9);
  if (!progress.cancelled()) bake.credit_leftovers();
  run(&SurfaceBake::box_slots, 0.93);
  if (!progress.cancelled()) bake.share_grids();
  run(&SurfaceBake::pack_slots, 0.98);
  if (progress.cancelled()) return cancelled_problem();
  bake.bound_tiles();
  bake.plant_tree(threads);
  progress.report(1, "Surface map ready");
  return map;
}

}  // namespace strata::mesh
