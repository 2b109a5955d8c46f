#include "mesh/adjacency.h"

#include <algorithm>

namespace strata::mesh {
namespace {

struct HalfEdge {
  std::uint32_t other_end;  // the larger of the edge's two vertices
  std::uint32_t corner;     // 3 * triangle + k
  bool upward;              // runs from the smaller to the larger vertex
};

}  // namespace

std::vector<std::uint32_t> edge_neighbours(std::span<const std::uint32_t> triangles, std::size_t vertex_count) {
  std::vector<std::uint32_t> neighbours(triangles.size(), kNoTriangle);
  // Half-edges bucketed by their smaller vertex: a counting sort, then tiny sorts.
  std::vector<std::uint32_t> first(vertex_count + 1, 0);
  const auto next_in_triangle = [&](std::size_t corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; };
  for (std::size_t c = 0; c < triangles.size(); ++c)
    ++first[std::min(triangles[c], triangles[next_in_triangle(c)]) + 1];
  for (std::size_t v = 1; v < first.size(); ++v) first[v] += first[v - 1];
  std::vector<HalfEdge> half_edges(triangles.size());
  auto cursor = first;
  for (std::size_t c = 0; c < triangles.size(); ++c) {
    const std::uint32_t from = triangles[c], to = triangles[next_in_triangle(c)];
    half_edges[cursor[std::min(from, to)]++] = {std::max(from, to), static_cast<std::uint32_t>(c), from < to};
  }
  for (std::size_t v = 0; v < vertex_count; ++v) {
    const auto begin = half_edges.begin() + first[v], end = half_edges.begin() + first[v + 1];
    std::sort(begin, end, [](const HalfEdge& a, const HalfEdge& b) {
      return a.other_end != b.other_end ? a.other_end < b.other_end : a.corner < b.corner;
    });
    for (auto i = begin; i != end;) {
      auto j = i;
      while (j != end && j->other_end == i->other_end) ++j;
      const bool is_manifold = j - i == 2 && i[0].upward != i[1].upward && i[0].corner / 3 != i[1].corner / 3;
      if (is_manifold) {
        neighbours[i[0].corner] = i[1].corner / 3;
        neighbours[i[1].corner] = i[0].corner / 3;
      }
      i = j;
    }
  }
  return neighbours;
}

}  // namespace strata::mesh
