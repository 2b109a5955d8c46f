#include "query/regions/open_close.h"

#include <bit>
#include <vector>

#include "core/progress.h"
#include "mesh/distance/surface_distance.h"
#include "query/regions/dilate_erode.h"

namespace strata::query {
namespace {

TexelSelection texels_of(const SurfaceValues& values, std::uint32_t value,
                         const mesh::SurfaceMap& map) {
  TexelSelection set(map.block_of_slot.size(), 0);
  for (std::uint32_t slot = 0; slot < set.size(); ++slot)
    for (std::uint64_t left = values.valid[slot] & map.surface_mask[slot]; left != 0;
         left &= left - 1) {
      const auto i = static_cast<std::uint32_t>(std::countr_zero(left));
      if (values.bits[slot * 64 + i] == value) set[slot] |= std::uint64_t{1} << i;
    }
  return set;
}

// Calls change(texel) for each texel of `set` that is not in `less`. Fails when cancelled.
template <class Change>
Result<SurfaceValues> changed(SurfaceValues values, const TexelSelection& set,
                              const TexelSelection& less, const Progress& progress,
                              Change&& change) {
  for (std::uint32_t slot = 0; slot < set.size(); ++slot) {
    if (slot % 4096 == 0 && progress.cancelled()) return cancelled_problem();
    for (std::uint64_t left = set[slot] & ~less[slot]; left != 0; left &= left - 1)
      change(values, slot * 64 + static_cast<std::uint32_t>(std::countr_zero(left)));
  }
  return values;
}

}  // namespace

Result<SurfaceValues> open_value(SurfaceValues values, std::uint32_t value, double radius,
                                 const mesh::SurfaceMap& map, const mesh::TexelGraph& graph,
                                 Progress& progress, int threads) {
  const TexelSelection set = texels_of(values, value, map), outside = surface_outside(set, map);
  const auto to_outside = STRATA_TRY(
      mesh::distances_along_surface(map, graph, outside, radius * kRim, progress, threads));
  const TexelSelection core = surface_outside(reached_texels(to_outside, map), map);
  const auto opened = STRATA_TRY(dilate(core, radius, map, graph, progress, threads));
  const SurfaceValues before = values;
  // A removed texel is within the radius of the outside. Otherwise it would be in the core.
  return changed(std::move(values), set, opened, progress,
                 [&](SurfaceValues& after, std::uint32_t texel) {
                   after.set(texel, before.of(to_outside.source_of(texel)));
                 });
}

Result<SurfaceValues> close_value(SurfaceValues values, std::uint32_t value, double radius,
                                  const mesh::SurfaceMap& map, const mesh::TexelGraph& graph,
                                  Progress& progress, int threads) {
  const TexelSelection set = texels_of(values, value, map);
  const auto dilated = STRATA_TRY(dilate(set, radius, map, graph, progress, threads));
  const auto closed = STRATA_TRY(erode(dilated, radius, map, graph, progress, threads));
  return changed(std::move(values), closed, set, progress,
                 [&](SurfaceValues& after, std::uint32_t texel) {
                   after.set(texel, {value, true});
                 });
}

}  // namespace strata::query
