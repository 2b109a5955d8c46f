#pragma once

#include <OpenMesh/Core/Mesh/TriConnectivity.hh>
#include <array>
#include <cstdint>
#include <span>

#include "mesh/surface/geometry.h"

namespace strata::mesh {

// The connectivity of a repaired mesh as half-edges of OpenMesh. Face i is triangle i, and vertex i
// is vertex i of the mesh. `sides_of` returns the half-edges of a triangle by its corners. The base
// class is OpenMesh's TriMesh_ArrayKernelT without points and attributes, because positions stay in
// arrays of double.
//
// Edges are matched by sorting. n triangles take n log n steps, independent of the number of
// triangles that meet in a vertex. The steps of OpenMesh's `add_face` increase with the square of
// that number, because it searches around vertices. Assertions of `add_face` may also terminate the
// program. Tests compare both methods. If the mesh is not a surface at an edge (repair prevents
// this), the edge is open on all sides.
//
// This class takes 50 bytes per triangle, and about 15 more bytes during construction. 10 million
// triangles take 500 MB. For long work, keep `face_neighbours` (12 bytes per triangle) and destroy
// this object.
class Connectivity final : public OpenMesh::TriConnectivity {
 public:
  // `triangles` has 3 different vertices per triangle, and at most kMaxTriangles triangles.
  Connectivity(std::span<const std::uint32_t> triangles, std::size_t vertex_count);
  Connectivity(const Connectivity&) = delete;
  Connectivity& operator=(const Connectivity&) = delete;

  // Returns the sides from corner k to the next corner, for k = 0, 1, 2.
  std::array<OpenMesh::HalfedgeHandle, 3> sides_of(std::uint32_t triangle) const {
    const auto first = halfedge_handle(OpenMesh::FaceHandle(static_cast<int>(triangle)));
    const auto second = next_halfedge_handle(first);
    return {first, second, next_halfedge_handle(second)};
  }
  // Returns true if there is no triangle on the other side.
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

// Returns the connectivity of the surface itself, with triangles joined across seams of the atlas.
Connectivity surface_connectivity(const Geometry& geometry);

}  // namespace strata::mesh
