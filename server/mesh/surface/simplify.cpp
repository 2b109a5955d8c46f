#include "mesh/surface/simplify.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace strata::mesh {
namespace {

// A step removes at most this share of the triangles, so that the work can be cancelled between
// steps.
constexpr std::size_t kStep = 4;
// A copy must cover this share of the atlas. Triangles that are not connected have no edge to
// collapse except their own, so they vanish. The area of the surface is no measure for that,
// because the roughness of a surface vanishes too.
constexpr double kMinCovered = 0.9;

double covered(const Geometry& geometry) {
  double sum = 0;
  for (std::size_t i = 0; i + 2 < geometry.indices.size(); i += 3) {
    const auto uv = [&](std::size_t corner) {
      return glm::dvec2(geometry.vertices[geometry.indices[corner]].uv);
    };
    const glm::dvec2 a = uv(i + 1) - uv(i), b = uv(i + 2) - uv(i);
    sum += std::abs(a.x * b.y - a.y * b.x) / 2;
  }
  return sum;
}

tl::unexpected<Error> too_few(std::size_t possible) {
  return fail(ErrorCode::invalid, "Too few triangles",
              "With so few triangles, the surface would lose its shape, or its texture would be "
              "torn at the seams of the atlas. Choose at least " +
                  std::to_string(possible) + " triangles.",
              "max_triangles");
}

// Returns the end of the vertices of each part. Vertices are numbered by first use, so each part
// has a range of them.
std::vector<std::uint32_t> vertex_ends_of_parts(const Geometry& geometry) {
  std::vector<std::uint32_t> ends;
  std::size_t index = 0;
  for (const std::uint32_t part_end : geometry.part_ends) {
    std::uint32_t end = ends.empty() ? 0 : ends.back();
    for (; index < 3 * std::size_t{part_end}; ++index)
      end = std::max(end, geometry.indices[index] + 1);
    ends.push_back(end);
  }
  return ends;
}

// Returns the triangles part by part, otherwise in the same order, and sets the ends of the parts.
std::vector<std::uint32_t> by_part(const Geometry& source, std::span<const std::uint32_t> indices,
                                   std::vector<std::uint32_t>& part_ends) {
  const std::vector<std::uint32_t> vertex_ends = vertex_ends_of_parts(source);
  std::vector<std::vector<std::uint32_t>> of_part(vertex_ends.size());
  for (std::size_t i = 0; i < indices.size(); i += 3) {
    auto& part = of_part[static_cast<std::size_t>(
        std::ranges::upper_bound(vertex_ends, indices[i]) - vertex_ends.begin())];
    part.insert(part.end(), {indices[i], indices[i + 1], indices[i + 2]});
  }
  std::vector<std::uint32_t> ordered;
  ordered.reserve(indices.size());
  for (const auto& part : of_part) {
    ordered.insert(ordered.end(), part.begin(), part.end());
    part_ends.push_back(static_cast<std::uint32_t>(ordered.size() / 3));
  }
  return ordered;
}

}  // namespace

Geometry with_triangles(const Geometry& source, std::span<const std::uint32_t> indices) {
  constexpr std::uint32_t kNone = 0xffffffffu;
  Geometry result;
  result.origin = source.origin;
  result.indices.reserve(indices.size());
  std::vector<std::uint32_t> ordered;
  if (!source.part_ends.empty()) {
    ordered = by_part(source, indices, result.part_ends);
    indices = ordered;
  }
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

Collapsed collapse_edges(const Geometry& geometry, std::size_t triangles, float max_error) {
  Collapsed collapsed;
  collapsed.indices.resize(geometry.indices.size());
  collapsed.indices.resize(
      meshopt_simplify(collapsed.indices.data(), geometry.indices.data(), geometry.indices.size(),
                       &geometry.vertices.front().position.x, geometry.vertices.size(),
                       sizeof(Vertex), 3 * triangles, max_error, 0, &collapsed.error));
  return collapsed;
}

std::uint64_t bytes_to_simplify(const Geometry& geometry) {
  // Quadrics, adjacency and collapses of meshoptimizer, and the copies of with_triangles.
  constexpr std::uint64_t kVertex = 192, kIndex = 48;
  return kVertex * geometry.vertices.size() + kIndex * geometry.indices.size();
}

Result<Geometry> simplify(const Geometry& geometry, std::size_t max_triangles, Progress& progress) {
  if (geometry.triangle_count() <= max_triangles) return geometry;
  const double all = covered(geometry);
  Geometry coarser;
  float left = kMaxSimplifyError;
  for (const Geometry* finer = &geometry; finer->triangle_count() > max_triangles;
       finer = &coarser) {
    if (progress.cancelled()) return cancelled_problem();
    progress.report(0, "Reducing the triangles");
    const std::size_t count = finer->triangle_count(),
                      target = std::max(max_triangles, count / kStep);
    const Collapsed collapsed = collapse_edges(*finer, target, left);
    left = std::max(0.0f, left - collapsed.error);
    Geometry next = with_triangles(*finer, collapsed.indices);
    if (covered(next) < kMinCovered * all) return too_few(count);
    if (next.triangle_count() > target) return too_few(next.triangle_count());
    coarser = std::move(next);
  }
  return coarser;
}

}  // namespace strata::mesh
