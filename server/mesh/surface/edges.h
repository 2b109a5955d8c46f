#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace strata::mesh {

// One side of a triangle, from corner k to corner k + 1.
struct HalfEdge {
  std::uint32_t other_end;  // the larger of its two vertices
  std::uint32_t corner : 31;
  std::uint32_t upward : 1;  // runs from the smaller to the larger vertex

  std::uint32_t triangle() const { return corner / 3; }
};
static_assert(sizeof(HalfEdge) == 8);

// Calls visit(smaller vertex, half-edges) for every edge of the mesh, in ascending order of the
// edge's vertices. The half-edges are all sides of triangles on the edge, in ascending order of
// corners. Supports at most 2³¹ - 1 corners and needs 8 bytes per corner.
template <class Visit>
void for_each_edge(std::span<const std::uint32_t> triangles, std::size_t vertex_count,
                   Visit&& visit) {
  const auto next_in_triangle = [](std::size_t corner) {
    return corner % 3 == 2 ? corner - 2 : corner + 1;
  };
  // The half-edges are grouped by their smaller vertex with a counting sort. The small groups are
  // then sorted.
  std::vector<std::uint32_t> begin(vertex_count + 1, 0);
  for (std::size_t c = 0; c < triangles.size(); ++c)
    ++begin[std::min(triangles[c], triangles[next_in_triangle(c)])];
  std::uint32_t sum = 0;
  for (auto& entry : begin) {
    const std::uint32_t count = entry;
    entry = sum;
    sum += count;
  }
  std::vector<HalfEdge> half_edges(triangles.size());
  for (std::size_t c = 0; c < triangles.size(); ++c) {
    const std::uint32_t from = triangles[c], to = triangles[next_in_triangle(c)];
    half_edges[begin[std::min(from, to)]++] = {
        std::max(from, to), static_cast<std::uint32_t>(c) & 0x7fffffffu, from < to ? 1u : 0u};
  }
  // The cursor of a vertex is now at the end of its group, where the next group begins.
  for (std::size_t v = 0; v < vertex_count; ++v) {
    const auto first = half_edges.begin() + (v == 0 ? 0 : begin[v - 1]),
               last = half_edges.begin() + begin[v];
    std::sort(first, last, [](const HalfEdge& a, const HalfEdge& b) {
      return a.other_end != b.other_end ? a.other_end < b.other_end : a.corner < b.corner;
    });
    for (auto i = first; i != last;) {
      auto j = i;
      while (j != last && j->other_end == i->other_end) ++j;
      visit(static_cast<std::uint32_t>(v),
            std::span<const HalfEdge>(&*i, static_cast<std::size_t>(j - i)));
      i = j;
    }
  }
}

}  // namespace strata::mesh
