#include "mesh/atlas.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "mesh/atlas_report.h"
#include "mesh/charts.h"
#include "mesh/packing.h"
#include "mesh/parallel.h"
#include "mesh/unit_mesh.h"

namespace strata::mesh {
namespace {

constexpr double kExpectedCoverage = 0.66;
// A narrow cone stretches least. Rugged surfaces fall into many small charts by it, whose margins fill the atlas: where
// less than kGoodCoverage is used, a wider cone is tried and the denser of the two atlases taken.
constexpr std::array<float, 2> kCones{55, 65};
constexpr double kGoodCoverage = 0.6;
// Laplacian rounds: scanner noise is gone after two, and more would only add stretch.
constexpr int kSmoothing = 2;
// No texel has two owners at the lowest resolution, nor at twice and four times that: layers are usually so fine.
constexpr int kVerifiedResolutions = 3;
constexpr int kMostMendingRounds = 20;
constexpr int kLargestResolution = 16384;
// 1/8192 texel at the lowest resolution: a multiple of 2^-24 of the atlas at 2048, so that float UVs hold it exactly
// and every GPU snaps the same vertex to the same place.
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

// Faces that share a texel with an earlier one at any of the verified resolutions.
std::vector<std::uint32_t> faces_in_conflict(const TriangleMesh& mesh, std::span<const glm::vec2> uvs,
                                             int lowest_resolution) {
  std::array<std::vector<std::uint32_t>, kVerifiedResolutions> found;
  parallel_for(2, kVerifiedResolutions, [&](int i) {
    const int resolution = lowest_resolution << (kVerifiedResolutions - 1 - i);  // the longest work first
    if (resolution <= kLargestResolution) found[i] = count_owners(mesh, uvs, resolution).shared_by;
  });
  std::vector<std::uint32_t> faces;
  for (const auto& some : found) faces.insert(faces.end(), some.begin(), some.end());
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  return faces;
}

tl::unexpected<Problem> no_room(std::size_t charts, int resolution) {
  return fail(422, "Cannot unwrap",
              "The surface falls into " + std::to_string(charts) + " separate pieces, more than " +
                  std::to_string(resolution) + " × " + std::to_string(resolution) +
                  " texels can hold apart. Weld or clean the mesh, or import it with a higher lowest resolution.",
              "lowest_resolution");
}

// Widest gap first: at lowest_resolution the gutter rings of neighbours (2 texels each) then stay apart.
Result<Packing> pack_with_gap(std::span<const Outline> outlines, double guess, int resolution,
                              const Progress& progress) {
  for (const int gap : {4, 2}) {
    auto packing = pack_densely(outlines, guess, resolution, gap, progress);
    if (packing) return std::move(*packing);
    if (progress.cancelled()) return cancelled_problem();
  }
  return no_room(outlines.size(), resolution);
}

struct Unwrap {
  std::vector<Chart> charts;
  std::vector<Outline> outlines;
  Packing packing;
  double coverage = 0;  // of the atlas, by area
};

double area_in_planes(const ChartSurface& surface, std::span<const Chart> charts) {
  double area = 0;
  for (const Chart& chart : charts)
    for (const auto face : chart.faces) {
      const glm::vec2 a = chart.project(surface.corner(chart, face, 0));
      const glm::vec2 ab = chart.project(surface.corner(chart, face, 1)) - a;
      const glm::vec2 ac = chart.project(surface.corner(chart, face, 2)) - a;
      area += std::abs(ab.x * ac.y - ab.y * ac.x) / 2;
    }
  return area;
}

Result<Unwrap> unwrap_once(const ChartSurface& surface, int attempt, int lowest_resolution, Progress& progress) {
  const double side = lowest_resolution;
  ChartOptions options;
  options.cone_degrees = kCones[attempt];
  options.progress_from = 0.1 + 0.35 * attempt;
  options.progress_to = options.progress_from + 0.3;
  options.texels_per_unit = std::sqrt(kExpectedCoverage * side * side / surface.smoothed_frames.total_area);
  options.largest_half_side = lowest_resolution / 5;
  auto charts = grow_charts(surface, options, progress);
  if (!charts) return cancelled_problem();
  progress.report(options.progress_to, "Packing the charts");
  auto outlines = make_outlines(surface, *charts);
  auto packing = pack_with_gap(outlines, options.texels_per_unit, lowest_resolution, progress);
  if (!packing) return tl::unexpected(packing.error());
  const double texels = area_in_planes(surface, *charts) * packing->texels_per_unit * packing->texels_per_unit;
  return Unwrap{std::move(*charts), std::move(outlines), std::move(*packing), texels / (side * side)};
}

}  // namespace

Result<Atlas> make_atlas(const TriangleMesh& mesh, int lowest_resolution, Progress& progress) {
  progress.report(0, "Measuring the surface");
  const UnitMesh unit = to_unit_mesh(mesh);
  const ChartSurface surface = make_chart_surface(unit, kSmoothing);
  if (surface.original_frames.total_area <= 0)
    return fail(422, "Cannot unwrap", "No triangle of the mesh has an area.", "file");
  if (progress.cancelled()) return cancelled_problem();

  std::optional<Unwrap> best;
  for (int attempt = 0; attempt < static_cast<int>(kCones.size()); ++attempt) {
    auto unwrap = unwrap_once(surface, attempt, lowest_resolution, progress);
    if (!unwrap && (!best || progress.cancelled())) return tl::unexpected(unwrap.error());
    if (!unwrap) break;
    const bool is_dense = unwrap->coverage >= kGoodCoverage;
    if (!best || unwrap->coverage > best->coverage) best = std::move(*unwrap);
    if (is_dense) break;
  }
  auto& [charts, outlines, packing, coverage] = *best;

  Atlas atlas;
  // Each round sends the later of two faces that share a texel to a chart of its own, so two or three rounds end it;
  // should one ever not, the report says what overlaps.
  for (int round = 0; round < kMostMendingRounds; ++round) {
    if (progress.cancelled()) return cancelled_problem();
    progress.report(0.85, "Checking that nothing overlaps");
    atlas.corner_uvs = lay_out(surface, charts, outlines, packing, lowest_resolution);
    const auto conflicts = faces_in_conflict(mesh, atlas.corner_uvs, lowest_resolution);
    if (conflicts.empty()) break;
    split_off(surface, conflicts, charts);
    outlines = make_outlines(surface, charts);
    auto repacked = pack_with_gap(outlines, packing.texels_per_unit, lowest_resolution, progress);
    if (!repacked) return tl::unexpected(repacked.error());
    packing = std::move(*repacked);
  }
  progress.report(0.95, "Measuring the unfolded surface");
  atlas.report = to_report(count_owners(mesh, atlas.corner_uvs, lowest_resolution),
                           measure_areas(mesh, atlas.corner_uvs, lowest_resolution), lowest_resolution);
  atlas.report.source = "made";
  atlas.report.charts = static_cast<int>(charts.size());
  progress.report(1, "Surface unfolded");
  return atlas;
}

}  // namespace strata::mesh
