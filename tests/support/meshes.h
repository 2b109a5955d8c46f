#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "mesh/surface/triangle_mesh.h"

namespace strata::test {

// Small deterministic meshes, one or more for each class of scans.
mesh::TriangleMesh sphere(int segments, double noise = 0);  // closed
mesh::TriangleMesh torus(int segments);                     // closed, with a hole through it
// Has a boundary; corner_uvs fill [0.05, 0.95]².
mesh::TriangleMesh open_grid(int cells, double height = 0.2);
// Has edges with three and with four triangles.
mesh::TriangleMesh grid_with_fins(int cells);
// A fan of triangles whose length is 1000 times their width.
mesh::TriangleMesh slivers(int count);
// Has 12 triangles; corner_uvs are 6 separate squares.
mesh::TriangleMesh cube_with_face_charts();
// Every 7th triangle is reversed, and some triangles occur twice.
mesh::TriangleMesh flipped_and_duplicate(int cells);
mesh::TriangleMesh separate_triangles(int count);  // not connected
// Cubes that are not connected, with 12 triangles and 8 vertices each.
mesh::TriangleMesh cubes(int count);
// Two flat caps with a hole, and straight and slanted flanks.
mesh::TriangleMesh gear(int teeth);
mesh::TriangleMesh flat_ring(int sides);              // in one plane, thin and hollow
mesh::TriangleMesh strips(int count, double length);  // not connected, two triangles each, 1 wide

mesh::TriangleMesh transformed(mesh::TriangleMesh mesh, double scale, const glm::dvec3& offset);

struct NamedMesh {
  std::string name;
  mesh::TriangleMesh mesh;
};
// NOLINTNEXTLINE(readability-identifier-naming): GoogleTest looks for it
inline void PrintTo(const NamedMesh& named, std::ostream* out) { *out << named.name; }
// Returns all meshes above, at sizes that tests can check by brute force.
std::vector<NamedMesh> mesh_classes();

}  // namespace strata::test
