#include "mesh/atlas/uv_move.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "mesh/atlas/atlas_report.h"
#include "mesh/atlas/canvas.h"
#include "mesh/atlas/chart_mask.h"
#include "mesh/atlas/charts.h"
#include "mesh/atlas/flatten.h"
#include "mesh/atlas/packing.h"
#include "mesh/atlas/unit_mesh.h"
#include "mesh/texels/texel_raster.h"

namespace strata::mesh {
namespace {

constexpr int kGap = 4;            // texels between charts
constexpr int kSmoothing = 0;      // a few faces have no noise, and smoothing would shrink them
constexpr double kUvSteps = 8192;  // as in atlas.cpp
// An attempt to place all charts. The first attempt in kAttempts that succeeds is used.
struct Attempt {
  float scale;     // of the triangles that stay
  double density;  // of the moved triangles, relative to the triangles that stay
};
constexpr std::array<Attempt, 7> kAttempts{{{1, 1},
                                            {1, 0.7},
                                            {1, 0.5},
                                            {0.9375f, 0.9375},
                                            {0.875f, 0.875},
                                            {0.75f, 0.75},
                                            {0.75f, 0.375}}};

// Returns the moved triangles as a separate mesh.
TriangleMesh part_of(const TriangleMesh& mesh, std::span<const std::uint32_t> triangles) {
  TriangleMesh part;
  std::vector<std::uint32_t> known;
  for (const auto t : triangles)
    known.insert(known.end(), &mesh.triangles[3 * std::size_t{t}],
                 &mesh.triangles[3 * std::size_t{t}] + 3);
  std::sort(known.begin(), known.end());
  known.erase(std::unique(known.begin(), known.end()), known.end());
  for (const auto vertex : known) part.positions.push_back(mesh.positions[vertex]);
  for (const auto t : triangles)
    for (std::size_t k = 0; k < 3; ++k)
      part.triangles.push_back(static_cast<std::uint32_t>(
          std::lower_bound(known.begin(), known.end(), mesh.triangles[3 * std::size_t{t} + k]) -
          known.begin()));
  return part;
}

// The texels whose centers lie in a triangle, and the texels that contain a corner.
class Taken {
 public:
  explicit Taken(int side)
      : side_(side), taken_(static_cast<std::size_t>(side) * static_cast<std::size_t>(side)) {}

  void add(const std::array<glm::dvec2, 3>& texels) {
    std::array<SnappedPoint, 3> snapped;
    for (std::size_t k = 0; k < 3; ++k) {
      snapped[k] = snap_to_subtexels(texels[k].x, texels[k].y);
      const int x = std::clamp(static_cast<int>(texels[k].x), 0, side_ - 1),
                y = std::clamp(static_cast<int>(texels[k].y), 0, side_ - 1);
      taken_[at(x, y)] = true;
    }
    CoverageRaster(snapped[0], snapped[1], snapped[2])
        .for_each_span(0, side_, 0, side_, [&](int y, int begin, int end) {
          for (int x = begin; x < end; ++x) taken_[at(x, y)] = true;
          return true;
        });
  }

  ChartMask mask() const {
    ChartMask mask{side_, side_, {0}, {}};
    for (int y = 0; y < side_; ++y) {
      for (int x = 0; x < side_;) {
        const int begin = x;
        while (x < side_ && taken_[at(x, y)]) ++x;
        if (x > begin)
          mask.runs.push_back({static_cast<std::int16_t>(begin), static_cast<std::int16_t>(x)});
        while (x < side_ && !taken_[at(x, y)]) ++x;
      }
      mask.first_run.push_back(static_cast<std::uint32_t>(mask.runs.size()));
    }
    return mask;
  }

 private:
  std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(side_) +
           static_cast<std::size_t>(x);
  }
  const int side_;
  std::vector<bool> taken_;
};

// Returns the position of a chart with the lowest top in any of its four turns.
std::optional<Placement> placed(Canvas& canvas, const ChartShape& shape, int side) {
  Canvas::Spot best;
  int best_turn = 0, best_top = side + 1;
  for (int turn = 0; turn < 4; ++turn) {
    const ChartMask& mask = shape.turned[static_cast<std::size_t>(turn)];
    const auto spot = canvas.find(mask, 0, best_top - mask.height);
    if (spot.x < 0) continue;
    best = spot, best_turn = turn, best_top = spot.y + mask.height;
  }
  if (best.x < 0) return std::nullopt;
  canvas.put(shape.turned[static_cast<std::size_t>(best_turn)], best);
  return Placement{best_turn, {best.x, best.y}, shape.box};
}

struct Unfolded {
  std::vector<Chart> charts;
  std::vector<glm::vec2> plane;
  std::vector<Outline> outlines;
};

std::optional<std::vector<Placement>> place(const Unfolded& unfolded, double texels_per_unit,
                                            int side, Canvas& canvas) {
  std::vector<Placement> placements(unfolded.charts.size());
  std::vector<std::uint32_t> order(placements.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto longer = [&](std::uint32_t i) {
    return std::max(unfolded.outlines[i].size.x, unfolded.outlines[i].size.y);
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](auto a, auto b) { return longer(a) > longer(b); });
  for (const auto i : order) {
    if (longer(i) * texels_per_unit >= side) return std::nullopt;
    auto placement = placed(canvas, make_shape(unfolded.outlines[i], texels_per_unit), side);
    if (!placement) return std::nullopt;
    placements[i] = *placement;
  }
  return placements;
}

}  // namespace

std::optional<MovedUvs> move_triangles(const TriangleMesh& mesh,
                                       std::span<const glm::vec2> corner_uvs,
                                       std::span<const std::uint32_t> moved, int resolution,
                                       Progress& progress) {
  std::vector<bool> moves(mesh.triangle_count());
  for (const auto t : moved) moves[t] = true;
  const double side = resolution;

  // Computes the texels per unit of length of the triangles that do not move.
  double uv_area = 0, area = 0;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    if (moves[t]) continue;
    const glm::dvec2 a = corner_uvs[3 * t], ab = glm::dvec2(corner_uvs[3 * t + 1]) - a,
                     ac = glm::dvec2(corner_uvs[3 * t + 2]) - a;
    const auto p = mesh.positions[mesh.triangles[3 * t]];
    uv_area += std::abs(ab.x * ac.y - ab.y * ac.x) / 2;
    area += glm::length(glm::cross(mesh.positions[mesh.triangles[3 * t + 1]] - p,
                                   mesh.positions[mesh.triangles[3 * t + 2]] - p)) /
            2;
  }
  if (!(uv_area > 0) || !(area > 0)) return std::nullopt;

  const TriangleMesh part = part_of(mesh, moved);
  const UnitMesh unit = to_unit_mesh(part);
  const ChartSurface surface = make_chart_surface(unit, kSmoothing);
  const double texels_per_unit = side * std::sqrt(uv_area / area) * unit.units_per_unit;
  ChartOptions options;
  options.texels_per_unit = texels_per_unit;
  options.largest_half_side = resolution / 5;
  auto charts = grow_charts(surface, options, progress);
  if (!charts || progress.cancelled()) return std::nullopt;
  Unfolded unfolded{std::move(*charts), {}, {}};
  flatten(surface, unfolded.charts, 0, progress, unfolded.plane);
  if (progress.cancelled()) return std::nullopt;
  unfolded.outlines = make_outlines(surface, unfolded.charts, unfolded.plane);

  for (const Attempt& attempt : kAttempts) {
    if (progress.cancelled()) return std::nullopt;
    MovedUvs result{{corner_uvs.begin(), corner_uvs.end()}, attempt.scale};
    Taken taken(resolution);
    for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
      if (moves[t]) continue;
      std::array<glm::dvec2, 3> texels;
      for (std::size_t k = 0; k < 3; ++k) {
        glm::vec2& uv = result.corner_uvs[3 * t + k];
        uv *= attempt.scale;
        texels[k] = glm::dvec2(uv) * side;
      }
      taken.add(texels);
    }
    Canvas canvas(resolution, kGap);
    canvas.put(taken.mask(), {0, 0});
    const double density = texels_per_unit * attempt.density;
    const auto placements = place(unfolded, density, resolution, canvas);
    if (!placements) continue;
    for (std::size_t c = 0; c < unfolded.charts.size(); ++c)
      for (const auto face : unfolded.charts[c].faces)
        for (std::size_t k = 0; k < 3; ++k) {
          const glm::vec2 local =
              unfolded.outlines[c].from_chart(unfolded.plane[3 * std::size_t{face} + k]);
          glm::dvec2 texels =
              glm::round((glm::dvec2(local) * density + kNear) * kUvSteps) / kUvSteps;
          texels = glm::clamp(texels, glm::dvec2(0), glm::dvec2((*placements)[c].box));
          result.corner_uvs[3 * std::size_t{moved[face]} + k] =
              glm::vec2((*placements)[c].to_atlas(texels) / side);
        }
    return result;
  }
  return std::nullopt;
}

}  // namespace strata::mesh
