#include "mesh/surface/boundary_loops.h"

namespace strata::mesh {
namespace {

std::size_t edge_number(const Connectivity& connectivity, OpenMesh::HalfedgeHandle side) {
  return static_cast<std::size_t>(connectivity.edge_handle(side).idx());
}

}  // namespace

std::vector<BoundaryLoop> boundary_loops(const Connectivity& connectivity) {
  std::vector<BoundaryLoop> loops;
  std::vector<bool> seen(connectivity.n_edges(), false);
  for (std::uint32_t triangle = 0; triangle < connectivity.n_faces(); ++triangle)
    for (const auto side : connectivity.sides_of(triangle)) {
      if (!connectivity.is_open(side) || seen[edge_number(connectivity, side)]) continue;
      // OpenMesh's boundary half-edges run opposite to the direction of the triangles.
      BoundaryLoop& loop = loops.emplace_back();
      const OpenMesh::HalfedgeHandle first = connectivity.opposite_halfedge_handle(side);
      auto rim = first;
      do {
        loop.push_back(connectivity.opposite_halfedge_handle(rim));
        seen[edge_number(connectivity, rim)] = true;
        rim = connectivity.prev_halfedge_handle(rim);
      } while (rim != first);
    }
  return loops;
}

}  // namespace strata::mesh
