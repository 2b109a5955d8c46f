#pragma once

#include <OpenMesh/Core/Mesh/TriConnectivity.hh>
#include <array>
#include <cstdint>
#include <span>

#include "mesh/surface/geometry.h"

namespace strata::mesh {

// The connectivity of a repaired mesh: half-edges of OpenMesh. Face i is triangle i, vertex i is
// vertex i, and `sides_of` returns the half-edges of a triangle by its corners. The base class is
// OpenMesh's TriMesh_ArrayKernelT without points and attributes: positions stay in arrays of
// double.
//
// Edges are matched by sorting: n triangles take n log n steps, independent of the number that meet
// in a vertex. `add_face` of OpenMesh takes the square of that number, because it searches around
// vertices, and its assertions may end the program. Tests compare both. Where the mesh is not a
// surface (which repair excludes) the edge is open on all sides.
//
// 50 bytes a triangle, and some 15 more during construction: 10 million triangles take 500 MB. For
// long work keep `face_neighbours`, 12 bytes a triangle, and drop this.
class Connectivity final : public OpenMesh::TriConnectivity {
 public:
  // `triangles`: 3 different vertices each. At most kMaxTriangles.
  Connectivity(std::span<const std::uint32_t> triangles, std::size_t vertex_count);
  Connectivity(const Connectivity&) = delete;
  Connectivity& operator=(const Connectivity&) = delete;

  // Sides from corner k to the next corner, k = 0, 1, 2.
  std::array<OpenMesh::HalfedgeHandle, 3> sides_of(std::uint32_t triangle) const {
    const auto first = halfedge_handle(OpenMesh::FaceHandle(static_cast<int>(triangle)));
    const auto second = next_halfedge_handle(first);
    return {first, second, next_halfedge_handle(second)};
  }
  // Whether no triangle is on the other side.
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

// The connectivity of the surface itself: triangles are joined across seams of the atlas.
Connectivity surface_connectivity(const Geometry& geometry);

}  // namespace strata::mesh
