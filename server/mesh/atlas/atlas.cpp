#include "mesh/atlas/atlas.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "mesh/atlas/atlas_limits.h"
#include "mesh/atlas/atlas_report.h"
#include "mesh/atlas/chart_conflicts.h"
#include "mesh/atlas/chart_cuts.h"
#include "mesh/atlas/chart_mask.h"
#include "mesh/atlas/charts.h"
#include "mesh/atlas/flatten.h"
#include "mesh/atlas/packing.h"
#include "mesh/atlas/unit_mesh.h"
#include "mesh/parallel.h"

namespace strata::mesh {
namespace {

constexpr int kThreads = 2;
constexpr double kExpectedCoverage = 0.66;
// A narrow cone stretches the charts least. On rugged surfaces it makes many small charts, and
// their margins fill the atlas. If the atlas uses less than kGoodCoverage, a wider cone is tried
// and the denser of the two atlases is used.
constexpr std::array<float, 2> kCones{55, 65};
constexpr double kGoodCoverage = 0.61, kTargetCoverage = 0.72;
// The number of texels between charts. With the wide gap, the gutter rings of neighboring charts (2
// texels each) stay apart at the lowest resolution.
constexpr int kWideGap = 4, kNarrowGap = 2;
// Hollow charts are cut in meshes of at least this many triangles. Smaller meshes have enough
// texels and benefit more from fewer seams.
constexpr std::size_t kCutsFrom = 5000;
constexpr double kMinHollow = 0.003;  // smallest box of a chart to cut, share of the atlas
// Faces that keep less than 1 / kMaxStretch of their area get their own charts if they would get at
// least kMinSqueezed texels. The footprint of faces in those charts is at least kStraightFootprint.
// No face reaches kNoFootprint, so this value makes each face a chart.
constexpr float kMaxStretch = 2.6f, kStraightFootprint = 0.45f, kNoFootprint = 2;
constexpr double kMinSqueezed = 0.1;
// Rounds of Laplacian smoothing. Two rounds remove scanner noise, and more rounds would only add
// stretch.
constexpr int kSmoothing = 2;
// No texel has two owners at the lowest resolution, at twice that resolution and at four times that
// resolution. These are the usual resolutions of layers.
constexpr int kVerifiedResolutions = 3;
constexpr int kMaxMendingRounds = 20;
// The factor that lowers the density, and the number of times it is applied before a new density is
// searched for.
constexpr double kRepackingStep = 0.995;
constexpr int kMaxRepackings = 8;
constexpr int kMaxResolution = 16384;
// 1/8192 texel at the lowest resolution. At 2048 this is a multiple of 2^-24 of the atlas, so float
// UVs represent it exactly. Every GPU then snaps a vertex to the same position.
constexpr double kUvSteps = 8192;

// The intermediate results of unwrapping a surface.
struct Unwrap {
  std::vector<Chart> charts;
  std::vector<glm::vec2> plane;  // of each corner, in its chart's plane
  std::vector<Outline> outlines;
  // longest side of a chart, in units of the plane; longer charts are squeezed; 0: no limit
  float longest = 0;
  int gap = kWideGap;  // texels between charts
  PackingStart start;
  double expected_coverage = 0;  // of the atlas, by area
  Packing packing;
};

std::vector<glm::vec2> lay_out(const Unwrap& unwrap, int resolution) {
  std::vector<glm::vec2> uvs(unwrap.plane.size(), glm::vec2(0));
  parallel_for(kThreads, static_cast<int>(unwrap.charts.size()), [&](int c) {
    const Placement& placement = unwrap.packing.placements[c];
    for (const auto face : unwrap.charts[c].faces)
      for (std::size_t k = 0; k < 3; ++k) {
        const glm::vec2 local =
            unwrap.outlines[c].from_chart(unwrap.plane[3 * std::size_t{face} + k]);
        glm::dvec2 texels = glm::dvec2(local) * unwrap.packing.texels_per_unit + kNear;
        texels = glm::clamp(glm::round(texels * kUvSteps) / kUvSteps, glm::dvec2(0),
                            glm::dvec2(placement.box));
        uvs[3 * std::size_t{face} + k] = glm::vec2(placement.to_atlas(texels) / double(resolution));
      }
  });
  return uvs;
}

std::vector<int> verified_resolutions(int lowest_resolution) {
  std::vector<int> resolutions;
  for (int i = 0; i < kVerifiedResolutions; ++i)
    if (const int resolution = lowest_resolution << i; resolution <= kMaxResolution)
      resolutions.push_back(resolution);
  return resolutions;
}

tl::unexpected<Error> no_room(std::size_t charts, int resolution) {
  return fail(ErrorCode::invalid, "Cannot unwrap the surface",
              "The surface consists of " + std::to_string(charts) + " separate pieces, more than " +
                  std::to_string(resolution) + " × " + std::to_string(resolution) +
                  " texels can separate. Weld or clean the mesh, or import it with a higher "
                  "minimum resolution.",
              "lowest_resolution");
}

// Returns the area of a face on the surface divided by its area in the plane. The result is
// proportional to the surface area that a texel of the face covers.
float stretch_of(const ChartSurface& surface, std::span<const glm::vec2> plane,
                 std::uint32_t face) {
  const glm::vec2* p = &plane[3 * std::size_t{face}];
  const glm::vec2 ab = p[1] - p[0], ac = p[2] - p[0];
  const float area = std::abs(ab.x * ac.y - ab.y * ac.x) / 2;
  return area > 0 ? surface.original_frames.areas[face] / area : 0;
}

// Returns the factor by which a chart may be shortened without exceeding kMaxStretch in any face.
float least_scale(const ChartSurface& surface, const Unwrap& unwrap, const Chart& chart) {
  float most = 1;
  for (const auto face : chart.faces)
    most = std::max(most, std::min(kMaxStretch, stretch_of(surface, unwrap.plane, face)));
  return most / kMaxStretch;
}

void outline(const ChartSurface& surface, Unwrap& unwrap) {
  unwrap.outlines = make_outlines(surface, unwrap.charts, unwrap.plane);
  if (unwrap.longest <= 0) return;
  for (std::size_t c = 0; c < unwrap.charts.size(); ++c) {
    const glm::vec2 size = unwrap.outlines[c].size;
    if (std::max(size.x, size.y) <= unwrap.longest) continue;
    const float least = least_scale(surface, unwrap, unwrap.charts[c]);
    const float x = std::max(least, std::min(1.f, unwrap.longest / size.x));
    unwrap.outlines[c].squeeze({x, std::max(least / x, std::min(1.f, unwrap.longest / size.y))});
  }
}

double area_in_planes(const Unwrap& unwrap) {
  double sum = 0;
  for (std::size_t c = 0; c < unwrap.charts.size(); ++c) {
    const glm::vec2 scale = unwrap.outlines[c].scale;
    double area = 0;
    for (const auto face : unwrap.charts[c].faces) {
      const glm::vec2* p = &unwrap.plane[3 * std::size_t{face}];
      const glm::vec2 ab = p[1] - p[0], ac = p[2] - p[0];
      area += std::abs(ab.x * ac.y - ab.y * ac.x) / 2;
    }
    sum += area * scale.x * scale.y;
  }
  return sum;
}

Result<void> begin_pack(int resolution, const Progress& progress, Unwrap& unwrap) {
  auto start = begin_packing(unwrap.outlines, resolution, unwrap.gap, progress, kThreads);
  if (progress.cancelled()) return cancelled_problem();
  if (!start) return no_room(unwrap.outlines.size(), resolution);
  unwrap.start = std::move(*start);
  const double texels = unwrap.start.expected_density / resolution;
  unwrap.expected_coverage = area_in_planes(unwrap) * texels * texels;
  return {};
}

// Packs with the narrow gap if the charts do not fit with the wide gap.
Result<void> begin_pack_somehow(int resolution, const Progress& progress, Unwrap& unwrap) {
  auto begun = begin_pack(resolution, progress, unwrap);
  if (begun || progress.cancelled() || unwrap.gap == kNarrowGap) return begun;
  unwrap.gap = kNarrowGap;
  return begin_pack(resolution, progress, unwrap);
}

Result<void> finish_pack(int resolution, const Progress& progress, Unwrap& unwrap) {
  auto packing = finish_packing(unwrap.outlines, resolution, unwrap.gap, std::move(unwrap.start),
                                progress, kThreads);
  if (progress.cancelled()) return cancelled_problem();
  if (!packing) return no_room(unwrap.outlines.size(), resolution);
  unwrap.packing = std::move(*packing);
  return {};
}

ChartOptions chart_options(const ChartSurface& surface, int lowest_resolution) {
  const double side = lowest_resolution;
  ChartOptions options;
  options.texels_per_unit =
      std::sqrt(kExpectedCoverage * side * side / surface.smoothed_frames.total_area);
  options.largest_half_side = lowest_resolution / 5;
  return options;
}

// Gives the faces their own charts and flattens these charts.
Result<void> split(const ChartSurface& surface, std::span<const std::uint32_t> faces,
                   float smallest_footprint, int lowest_resolution, const Progress& progress,
                   Unwrap& unwrap) {
  if (faces.empty()) return {};
  ChartOptions options = chart_options(surface, lowest_resolution);
  options.smallest_footprint = smallest_footprint;
  options.keeps_flat_pieces = smallest_footprint < kNoFootprint;
  const auto first = split_off(surface, faces, options, progress, unwrap.charts);
  if (!first) return cancelled_problem();
  flatten(surface, unwrap.charts, *first, progress, unwrap.plane, kThreads);
  return {};
}

Result<Unwrap> unwrap_once(const ChartSurface& surface, int attempt, int lowest_resolution,
                           Progress& progress) {
  ChartOptions options = chart_options(surface, lowest_resolution);
  options.cone_degrees = kCones[attempt];
  options.progress_from = 0.1 + 0.35 * attempt;
  options.progress_to = options.progress_from + 0.25;
  auto charts = grow_charts(surface, options, progress);
  if (!charts) return cancelled_problem();
  Unwrap unwrap;
  unwrap.charts = std::move(*charts);
  progress.report(options.progress_to, "Flattening the charts");
  flatten(surface, unwrap.charts, 0, progress, unwrap.plane, kThreads);
  const auto smallest_area =
      static_cast<float>(kMinSqueezed / (options.texels_per_unit * options.texels_per_unit));
  const auto squeezed = squeezed_faces(surface, unwrap.plane, kMaxStretch, smallest_area);
  if (auto done = split(surface, squeezed, kStraightFootprint, lowest_resolution, progress, unwrap);
      !done)
    return tl::unexpected(done.error());
  if (progress.cancelled()) return cancelled_problem();
  progress.report(options.progress_to + 0.05, "Packing the charts");
  outline(surface, unwrap);
  STRATA_TRY(begin_pack_somehow(lowest_resolution, progress, unwrap));
  return unwrap;
}

// Replaces `unwrap` by `changed` if `changed` has the higher coverage.
Result<void> take_denser(int lowest_resolution, const Progress& progress, Unwrap changed,
                         Unwrap& unwrap) {
  auto begun = begin_pack(lowest_resolution, progress, changed);
  if (progress.cancelled()) return begun;
  if (begun && changed.expected_coverage > unwrap.expected_coverage) unwrap = std::move(changed);
  return {};
}

// Squeezes the charts that are longer than the side of an atlas with the target coverage.
void squeeze_long(const ChartSurface& surface, int lowest_resolution, Unwrap& unwrap) {
  // Squeezed charts have a smaller area, so each round must squeeze the charts a little more.
  for (int round = 0; round < 3; ++round) {
    unwrap.longest = static_cast<float>((1 - 2.0 * kWideGap / lowest_resolution) *
                                        std::sqrt(area_in_planes(unwrap) / kTargetCoverage));
    outline(surface, unwrap);
  }
}

// Raises a low coverage until it is good enough. Squeezes the charts whose length keeps all other
// charts small, cuts hollow charts, and narrows the gaps.
Result<void> use_more(const ChartSurface& surface, int lowest_resolution, const Progress& progress,
                      Unwrap& unwrap) {
  const auto is_poor = [&] { return unwrap.expected_coverage < kGoodCoverage; };
  const double area = area_in_planes(unwrap);
  const double longest = std::sqrt(area / kTargetCoverage);
  const bool is_long = std::any_of(
      unwrap.outlines.begin(), unwrap.outlines.end(),
      [&](const auto& some) { return double{std::max(some.size.x, some.size.y)} > longest; });
  if (is_long) {
    Unwrap shorter = unwrap;
    squeeze_long(surface, lowest_resolution, shorter);
    STRATA_TRY(take_denser(lowest_resolution, progress, std::move(shorter), unwrap));
  }
  if (is_poor() && surface.mesh.triangle_count() >= kCutsFrom) {
    Unwrap cut = unwrap;
    if (cut_hollow_charts(surface, cut.plane,
                          static_cast<float>(kMinHollow * area / kTargetCoverage), cut.charts)) {
      cut.longest = 0;
      outline(surface, cut);
      squeeze_long(surface, lowest_resolution, cut);
      STRATA_TRY(take_denser(lowest_resolution, progress, std::move(cut), unwrap));
    }
  }
  if (is_poor() && unwrap.gap > kNarrowGap) {
    Unwrap nearer = unwrap;
    nearer.gap = kNarrowGap;
    STRATA_TRY(take_denser(lowest_resolution, progress, std::move(nearer), unwrap));
  }
  return {};
}

// Packs again after a few small charts were added. They usually fit at the same or almost the same
// density.
Result<void> pack_again(int lowest_resolution, const Progress& progress, Unwrap& unwrap) {
  for (int attempt = 0; attempt < kMaxRepackings; ++attempt) {
    const double density = unwrap.packing.texels_per_unit * std::pow(kRepackingStep, attempt);
    auto packing = pack_at(unwrap.outlines, density, lowest_resolution, unwrap.gap, progress);
    if (packing) return unwrap.packing = std::move(*packing), Result<void>{};
    if (progress.cancelled()) return cancelled_problem();
  }
  STRATA_TRY(begin_pack_somehow(lowest_resolution, progress, unwrap));
  return finish_pack(lowest_resolution, progress, unwrap);
}

}  // namespace

Result<Atlas> make_atlas(const TriangleMesh& mesh, int lowest_resolution, Progress& progress) {
  progress.report(0, "Measuring the surface");
  const UnitMesh unit = to_unit_mesh(mesh);
  const ChartSurface surface = make_chart_surface(unit, kSmoothing);
  if (surface.original_frames.total_area <= 0)
    return fail(ErrorCode::invalid, "Cannot unwrap the surface",
                "All triangles of the mesh have an area of 0. Check the file.", "file");
  if (progress.cancelled()) return cancelled_problem();

  std::optional<Unwrap> best;
  for (int attempt = 0; attempt < static_cast<int>(kCones.size()); ++attempt) {
    auto unwrap = unwrap_once(surface, attempt, lowest_resolution, progress);
    if (!unwrap && (!best || progress.cancelled())) return tl::unexpected(unwrap.error());
    if (!unwrap) break;
    const bool is_dense = unwrap->expected_coverage >= kGoodCoverage;
    if (!best || unwrap->expected_coverage > best->expected_coverage) best = std::move(*unwrap);
    if (is_dense) break;
  }
  if (best->expected_coverage < kGoodCoverage)
    STRATA_TRY(use_more(surface, lowest_resolution, progress, *best));

  STRATA_TRY(finish_pack(lowest_resolution, progress, *best));

  Atlas atlas;
  const auto resolutions = verified_resolutions(lowest_resolution);
  // If two faces share a texel, the later face moves to its own chart. Two or three rounds are
  // usually enough. If they are not, the report lists the overlap.
  for (int round = 0; round < kMaxMendingRounds; ++round) {
    if (progress.cancelled()) return cancelled_problem();
    progress.report(0.85, "Checking that nothing overlaps");
    atlas.corner_uvs = lay_out(*best, lowest_resolution);
    const auto conflicts = faces_in_conflict(best->charts, atlas.corner_uvs, resolutions, kThreads);
    if (conflicts.empty()) break;
    const float footprint = round == 0 ? kStraightFootprint : kNoFootprint;
    STRATA_TRY(split(surface, conflicts, footprint, lowest_resolution, progress, *best));
    outline(surface, *best);
    STRATA_TRY(pack_again(lowest_resolution, progress, *best));
  }
  progress.report(0.95, "Measuring the unfolded surface");
  TexelCounts owners;
  AtlasMeasure measure;
  parallel_for(kThreads, 2, [&](int i) {
    if (i == 0)
      owners = count_owners(mesh, atlas.corner_uvs, lowest_resolution);
    else
      measure = measure_areas(mesh, atlas.corner_uvs);
  });
  atlas.report = make_report(mesh, atlas.corner_uvs, lowest_resolution, owners, measure);
  atlas.report.source = "made";
  atlas.report.charts = static_cast<int>(best->charts.size());
  atlas.report.limits = limits_of_packing(best->outlines, best->packing, lowest_resolution,
                                          best->gap, atlas.report.coverage);
  progress.report(1, "Surface unfolded");
  return atlas;
}

}  // namespace strata::mesh
