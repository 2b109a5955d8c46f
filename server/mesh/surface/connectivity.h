#pragma once

#include <OpenMesh/Core/Mesh/TriConnectivity.hh>
#include <array>
#include <cstdint>
#include <span>

#include "mesh/surface/geometry.h"

namespace strata::mesh {

// How the triangles of a repaired mesh hang together: half-edges of OpenMesh. Face i is triangle i,
// vertex i is vertex i, and `sides_of` names the half-edges of a triangle by its corners. The base
// is what OpenMesh's TriMesh_ArrayKernelT is without points and attributes: positions stay in
// arrays of double.
//
// Edges are matched by sorting: n triangles take n log n steps, however many of them meet in a
// vertex. `add_face` of OpenMesh takes the square of these, because it searches around vertices,
// and assertions in it may end the program. Tests hold one against the other. Where the mesh is no
// surface (which repair does not leave) the edge is open on all sides.
//
// 50 bytes a triangle, and some 15 more while it is made: 10 million triangles take 500 MB. What
// goes on for long keeps `face_neighbours`, 12 bytes a triangle, and drops this.
class Connectivity final : public OpenMesh::TriConnectivity {
 public:
  // `triangles`: 3 vertices each, all different. At most kMaxTriangles.
  Connectivity(std::span<const std::uint32_t> triangles, std::size_t vertex_count);
  Connectivity(const Connectivity&) = delete;
  Connectivity& operator=(const Connectivity&) = delete;

  // From corner k to the next corner, k = 0, 1, 2.
  std::array<OpenMesh::HalfedgeHandle, 3> sides_of(std::uint32_t triangle) const {
    const auto first = halfedge_handle(OpenMesh::FaceHandle(static_cast<int>(triangle)));
    const auto second = next_halfedge_handle(first);
    return {first, second, next_halfedge_handle(second)};
  }
  // Whether there is no triangle on the other side.
  bool is_open(OpenMesh::HalfedgeHandle side) const {
    return is_boundary(opposite_halfedge_handle(side));
  }
  std::uint32_t from(OpenMesh::HalfedgeHandle side) const {
    return static_cast<std::uint32_t>(from_vertex_handle(side).idx());
  }
  std::uint32_t to(OpenMesh::HalfedgeHandle side) const {
    return static_cast<std::uint32_t>(to_vertex_handle(side).idx());
  }
};

// The connectivity of the surface itself: seams of the atlas join.
Connectivity surface_connectivity(const Geometry& geometry);

}  // namespace strata::mesh
