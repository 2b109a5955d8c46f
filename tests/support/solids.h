#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include "mesh/surface/geometry.h"

namespace strata::test {

// Builds a geometry without an atlas, for code that needs no texture coordinates.
inline mesh::Geometry geometry_of(const mesh::TriangleMesh& mesh) {
  return mesh::build_geometry(mesh, {});
}

inline void add(mesh::TriangleMesh& mesh, const mesh::TriangleMesh& other, double scale,
                bool inside_out) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (const auto& position : other.positions) mesh.positions.push_back(scale * position);
  for (std::size_t i = 0; i < other.triangles.size(); i += 3)
    for (const std::size_t corner : {0, 1, 2})
      mesh.triangles.push_back(first + other.triangles[i + (inside_out ? 2 - corner : corner)]);
}

// Returns a ball of radius 1.
inline mesh::TriangleMesh ball(int rows = 64) {
  mesh::TriangleMesh mesh;
  const int columns = 2 * rows;
  mesh.positions.push_back({0, 0, 1});
  for (int row = 1; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const double down = std::numbers::pi * row / rows,
                   around = 2 * std::numbers::pi * column / columns;
      mesh.positions.push_back(
          {std::sin(down) * std::cos(around), std::sin(down) * std::sin(around), std::cos(down)});
    }
  mesh.positions.push_back({0, 0, -1});
  const auto at = [&](int row, int column) {
    return static_cast<std::uint32_t>(1 + (row - 1) * columns + column % columns);
  };
  const auto last = static_cast<std::uint32_t>(mesh.positions.size() - 1);
  for (int column = 0; column < columns; ++column) {
    for (const auto corner : {0u, at(1, column), at(1, column + 1)})
      mesh.triangles.push_back(corner);
    for (int row = 1; row + 1 < rows; ++row)
      for (const auto corner : {at(row, column), at(row + 1, column), at(row, column + 1),
                                at(row, column + 1), at(row + 1, column), at(row + 1, column + 1)})
        mesh.triangles.push_back(corner);
    for (const auto corner : {at(rows - 1, column), last, at(rows - 1, column + 1)})
      mesh.triangles.push_back(corner);
  }
  return mesh;
}

// A closed box from `low` to `high`.
inline mesh::TriangleMesh box(const glm::dvec3& low, const glm::dvec3& high) {
  mesh::TriangleMesh mesh;
  for (unsigned corner = 0; corner < 8; ++corner)
    mesh.positions.push_back({(corner & 1) != 0 ? high.x : low.x,
                              (corner & 2) != 0 ? high.y : low.y,
                              (corner & 4) != 0 ? high.z : low.z});
  mesh.triangles = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                    2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
  return mesh;
}

// One triangle far below, so that nothing gives shade or shelter.
inline mesh::TriangleMesh nothing_near() {
  mesh::TriangleMesh mesh;
  mesh.positions = {{-1, -1, -1000}, {1, -1, -1000}, {0, 1, -1000}};
  mesh.triangles = {0, 1, 2};
  return mesh;
}

}  // namespace strata::test
