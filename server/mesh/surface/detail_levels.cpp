#include "mesh/surface/detail_levels.h"

#include <algorithm>

#include "mesh/surface/simplify.h"

namespace strata::mesh {
namespace {

constexpr std::size_t kStep = 4;
// A level is kept only if it has at most this share of the triangles of the previous level.
constexpr double kWorthwhile = 0.7;
// A level is kept only if it has at least this share of the area. Simplification of unconnected
// triangles only leaves holes.
constexpr double kMinArea = 0.9;
// As a share of the model's extent. The triangle count should determine a level, not this limit.
constexpr float kMaxError = 0.05f;

// Returns the target triangle counts, beginning with the finest level.
std::vector<std::size_t> level_sizes(std::size_t triangles) {
  std::vector<std::size_t> sizes;
  for (std::size_t size = kCoarsestLevelTriangles; 2 * size <= triangles; size *= kStep)
    sizes.push_back(size);
  std::reverse(sizes.begin(), sizes.end());
  return sizes;
}

}  // namespace

Result<std::vector<Geometry>> make_detail_levels(const Geometry& geometry, Progress& progress) {
  const std::vector<std::size_t> sizes = level_sizes(geometry.triangle_count());
  const double area = surface_area(geometry);
  std::vector<Geometry> levels;
  levels.reserve(sizes.size());
  for (const std::size_t size : sizes) {
    if (progress.cancelled()) return cancelled_problem();
    progress.report(static_cast<double>(levels.size()) / static_cast<double>(sizes.size()),
                    "Making coarser copies");
    const Geometry& finer = levels.empty() ? geometry : levels.back();
    const std::vector<std::uint32_t> indices = collapse_edges(finer, size, kMaxError).indices;
    const double share =
        static_cast<double>(indices.size()) / static_cast<double>(finer.indices.size());
    if (indices.empty() || share > kWorthwhile) break;
    Geometry level = with_triangles(finer, indices);
    if (surface_area(level) < kMinArea * area) break;
    levels.push_back(std::move(level));
  }
  return levels;
}

}  // namespace strata::mesh
