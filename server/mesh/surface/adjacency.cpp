#include "mesh/surface/adjacency.h"

#include "mesh/surface/edges.h"

namespace strata::mesh {

std::vector<std::uint32_t> edge_neighbours(std::span<const std::uint32_t> triangles,
                                           std::size_t vertex_count) {
  std::vector<std::uint32_t> neighbours(triangles.size(), kNoTriangle);
  for_each_edge(triangles, vertex_count, [&](std::uint32_t, std::span<const HalfEdge> sides) {
    const bool is_manifold = sides.size() == 2 && sides[0].upward != sides[1].upward &&
                             sides[0].triangle() != sides[1].triangle();
    if (!is_manifold) return;
    neighbours[sides[0].corner] = sides[1].triangle();
    neighbours[sides[1].corner] = sides[0].triangle();
  });
  return neighbours;
}

}  // namespace strata::mesh
