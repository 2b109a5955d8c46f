#include "mesh/atlas.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "mesh/atlas_report.h"
#include "mesh/charts.h"
#include "mesh/packing.h"
#include "mesh/unit_mesh.h"

namespace strata::mesh {
namespace {

constexpr double kExpectedCoverage = 0.66;
// No texel has two owners up to this multiple of the lowest resolution: layers are usually that fine.
constexpr int kVerifiedLayers = 4;
constexpr int kLargestResolution = 16384;
// 1/8192 texel at the lowest resolution: a multiple of 2^-24 of the atlas at 2048, so that float UVs hold it exactly and
// every GPU snaps the same vertex to the same place.
constexpr double kUvSteps = 8192;

std::vector<glm::vec2> lay_out(const ChartSurface& surface, std::span<const Chart> charts,
                               std::span<const Outline> outlines, const Packing& packing, int resolution) {
  std::vector<glm::vec2> uvs(3 * surface.mesh.triangle_count(), glm::vec2(0));
  for (std::size_t c = 0; c < charts.size(); ++c) {
    const Placement& placement = packing.placements[c];
    for (const auto face : charts[c].faces)
      for (int k = 0; k < 3; ++k) {
        const glm::vec2 local = outlines[c].from_chart(charts[c].project(surface.corner(charts[c], face, k)));
        glm::dvec2 texels = glm::dvec2(local) * packing.texels_per_unit;
        texels = glm::clamp(glm::round(texels * kUvSteps) / kUvSteps, glm::dvec2(0), glm::dvec2(placement.box));
        uvs[3 * face + k] = glm::vec2(placement.to_atlas(texels) / double(resolution));
      }
  }
  return uvs;
}

// Widest gap first: at lowest_resolution the gutter rings of neighbours (2 texels each) then stay apart.
std::optional<Packing> pack_with_gap(std::span<const Outline> outlines, double guess, int resolution) {
  for (const int gap : {4, 2})
    if (auto packing = pack_densely(outlines, guess, resolution, gap)) return packing;
  return std::nullopt;
}

Result<Atlas> no_room(std::size_t charts, int resolution) {
  return fail(422, "Cannot unwrap",
              "The surface falls into " + std::to_string(charts) + " separate pieces, more than " +
                  std::to_string(resolution) + " × " + std::to_string(resolution) +
                  " texels can hold apart. Weld or clean the mesh, or import it with a higher lowest resolution.",
              "lowest_resolution");
}

}  // namespace

Result<Atlas> make_atlas(const TriangleMesh& mesh, int lowest_resolution, Progress& progress) {
  progress.report(0, "Measuring the surface");
  const UnitMesh unit = to_unit_mesh(mesh);
  ChartOptions options;
  const ChartSurface surface = make_chart_surface(unit, options.smoothing);
  if (surface.original_frames.total_area <= 0)
    return fail(422, "Cannot unwrap", "No triangle of the mesh has an area.", "file");
  if (progress.cancelled()) return cancelled_problem();

  const double side = lowest_resolution;
  options.texels_per_unit = std::sqrt(kExpectedCoverage * side * side / surface.smoothed_frames.total_area);
  options.largest_half_side = lowest_resolution * 2 / 5;
  auto charts = grow_charts(surface, options, progress);
  if (!charts) return cancelled_problem();

  progress.report(0.7, "Packing the charts");
  auto outlines = make_outlines(surface, *charts);
  auto packing = pack_with_gap(outlines, options.texels_per_unit, lowest_resolution);
  if (!packing) return no_room(charts->size(), lowest_resolution);

  const int verified_resolution = std::min(kVerifiedLayers * lowest_resolution, kLargestResolution);
  Atlas atlas;
  for (;;) {
    if (progress.cancelled()) return cancelled_problem();
    progress.report(0.85, "Verifying the atlas");
    atlas.corner_uvs = lay_out(surface, *charts, outlines, *packing, lowest_resolution);
    const auto found = count_owners(mesh, atlas.corner_uvs, verified_resolution);
    if (found.shared_by.empty()) break;
    // Each round sends the later of two faces that share a texel to a chart of its own, so it ends.
    split_off(surface, found.shared_by, *charts);
    outlines = make_outlines(surface, *charts);
    packing = pack_with_gap(outlines, packing->texels_per_unit, lowest_resolution);
    if (!packing) return no_room(charts->size(), lowest_resolution);
  }
  progress.report(0.95, "Measuring the atlas");
  atlas.report = to_report(count_owners(mesh, atlas.corner_uvs, lowest_resolution),
                           measure_areas(mesh, atlas.corner_uvs, lowest_resolution), lowest_resolution);
  atlas.report.source = "made";
  atlas.report.charts = static_cast<int>(charts->size());
  progress.report(1, "Atlas made");
  return atlas;
}

}  // namespace strata::mesh
