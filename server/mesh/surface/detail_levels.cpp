#include "mesh/surface/detail_levels.h"

#include <meshoptimizer.h>

#include <algorithm>

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

// Returns a geometry of the vertices that `indices` use, numbered by first use.
Geometry compact(const Geometry& source, const std::vector<std::uint32_t>& indices) {
  constexpr std::uint32_t kNone = 0xffffffffu;
  Geometry result;
  result.origin = source.origin;
  result.indices.reserve(indices.size());
  std::vector<std::uint32_t> vertex_of(source.vertices.size(), kNone),
      position_of(source.positions.size(), kNone);
  for (const std::uint32_t old : indices) {
    if (vertex_of[old] == kNone) {
      Vertex vertex = source.vertices[old];
      std::uint32_t& position = position_of[vertex.position_index];
      if (position == kNone) {
        position = static_cast<std::uint32_t>(result.positions.size());
        result.positions.push_back(source.positions[vertex.position_index]);
      }
      vertex.position_index = position;
      vertex_of[old] = static_cast<std::uint32_t>(result.vertices.size());
      result.vertices.push_back(vertex);
    }
    result.indices.push_back(vertex_of[old]);
  }
  find_boxes(result);
  return result;
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
    std::vector<std::uint32_t> indices(finer.indices.size());
    indices.resize(meshopt_simplify(indices.data(), finer.indices.data(), finer.indices.size(),
                                    &finer.vertices.front().position.x, finer.vertices.size(),
                                    sizeof(Vertex), 3 * size, kMaxError, 0, nullptr));
    const double share =
        static_cast<double>(indices.size()) / static_cast<double>(finer.indices.size());
    if (indices.empty() || share > kWorthwhile) break;
    Geometry level = compact(finer, indices);
    if (surface_area(level) < kMinArea * area) break;
    levels.push_back(std::move(level));
  }
  return levels;
}

}  // namespace strata::mesh
