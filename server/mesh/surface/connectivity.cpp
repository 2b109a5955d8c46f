#include "mesh/surface/connectivity.h"

#include <vector>

#include "mesh/surface/edges.h"

namespace strata::mesh {
namespace {

using OpenMesh::FaceHandle;
using OpenMesh::HalfedgeHandle;
using OpenMesh::VertexHandle;

template <class Handle>
Handle numbered(std::uint32_t number) {
  return Handle(static_cast<int>(number));
}

}  // namespace

Connectivity::Connectivity(std::span<const std::uint32_t> triangles, std::size_t vertex_count) {
  // Indexed by the first corner of each side. Stores the corner of the opposite side, and later the
  // half-edge of the side.
  constexpr std::uint32_t kOpen = 0xffffffffu;
  std::vector<std::uint32_t> sides(triangles.size(), kOpen);
  std::size_t edge_count = triangles.size();
  for_each_edge(triangles, vertex_count, [&](std::uint32_t, std::span<const HalfEdge> at_edge) {
    if (at_edge.size() != 2 || at_edge[0].upward == at_edge[1].upward) return;
    sides[at_edge[0].corner] = at_edge[1].corner;
    sides[at_edge[1].corner] = at_edge[0].corner;
    --edge_count;
  });
  resize(vertex_count, edge_count, triangles.size() / 3);
  // Edges are in the order of the triangles, so neighboring faces are near each other in memory.
  std::uint32_t next_edge = 0;
  for (std::uint32_t first = 0; first < triangles.size(); first += 3) {
    const auto face = numbered<FaceHandle>(first / 3);
    std::array<HalfedgeHandle, 3> around;
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t across = sides[first + k];
      const auto from = numbered<VertexHandle>(triangles[first + k]);
      const auto side = across < first + k
                            ? opposite_halfedge_handle(numbered<HalfedgeHandle>(sides[across]))
                            : numbered<HalfedgeHandle>(2 * next_edge++);
      sides[first + k] = static_cast<std::uint32_t>(side.idx());
      set_vertex_handle(side, numbered<VertexHandle>(triangles[first + (k + 1) % 3]));
      if (across == kOpen) set_vertex_handle(opposite_halfedge_handle(side), from);
      set_face_handle(side, face);
      set_halfedge_handle(from, side);
      around[k] = side;
    }
    for (std::size_t k = 0; k < 3; ++k) set_next_halfedge_handle(around[k], around[(k + 1) % 3]);
    set_halfedge_handle(face, around[0]);
  }
  // The rim continues where the fan of triangles around a vertex ends. OpenMesh requires that a
  // vertex on a rim refers to the half-edge that leaves the vertex along the rim.
  for (std::uint32_t i = 0; i < n_halfedges(); ++i) {
    const auto rim = numbered<HalfedgeHandle>(i);
    if (!is_boundary(rim)) continue;
    HalfedgeHandle leaving = opposite_halfedge_handle(rim);
    do leaving = opposite_halfedge_handle(prev_halfedge_handle(leaving));
    while (!is_boundary(leaving));
    set_next_halfedge_handle(rim, leaving);
    set_halfedge_handle(to_vertex_handle(rim), leaving);
  }
}

Connectivity surface_connectivity(const Geometry& geometry) {
  std::vector<std::uint32_t> positions(geometry.indices.size());
  for (std::size_t c = 0; c < positions.size(); ++c)
    positions[c] = geometry.vertices[geometry.indices[c]].position_index;
  return {positions, geometry.positions.size()};
}

}  // namespace strata::mesh
