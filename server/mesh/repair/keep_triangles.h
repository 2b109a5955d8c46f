#pragma once

#include "mesh/surface/triangle_mesh.h"

namespace strata::mesh {

// Copies the data of a triangle to an earlier position.
inline void move_triangle(TriangleMesh& mesh, std::size_t from, std::size_t to) {
  for (std::size_t k = 0; k < 3; ++k) mesh.triangles[3 * to + k] = mesh.triangles[3 * from + k];
  if (!mesh.corner_uvs.empty())
    for (std::size_t k = 0; k < 3; ++k) mesh.corner_uvs[3 * to + k] = mesh.corner_uvs[3 * from + k];
  if (!mesh.triangle_materials.empty()) mesh.triangle_materials[to] = mesh.triangle_materials[from];
}

inline void resize_triangles(TriangleMesh& mesh, std::size_t count) {
  mesh.triangles.resize(3 * count);
  if (!mesh.corner_uvs.empty()) mesh.corner_uvs.resize(3 * count);
  if (!mesh.triangle_materials.empty()) mesh.triangle_materials.resize(count);
}

// Keeps the triangles for which keep(number) returns true, in their order.
template <class Keep>
void keep_triangles(TriangleMesh& mesh, Keep&& keep) {
  std::size_t kept_triangles = 0;
  for (std::size_t i = 0; i < mesh.triangle_count(); ++i)
    if (keep(i)) move_triangle(mesh, i, kept_triangles++);
  resize_triangles(mesh, kept_triangles);
}

}  // namespace strata::mesh
