#include "support/meshes.h"

#include <array>
#include <cmath>
#include <numbers>
#include <random>

namespace strata::test {
namespace {

using mesh::TriangleMesh;

void add_triangle(TriangleMesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  mesh.triangles.insert(mesh.triangles.end(), {a, b, c});
}

// Adds two triangles for each cell of a grid of vertices. The grid is closed along x, and
// optionally along y.
void add_cells(TriangleMesh& mesh, int columns, int rows, bool closed_rows) {
  const auto at = [&](int x, int y) {
    return static_cast<std::uint32_t>((y % rows) * columns + x % columns);
  };
  for (int y = 0; y < (closed_rows ? rows : rows - 1); ++y)
    for (int x = 0; x < columns; ++x) {
      add_triangle(mesh, at(x, y), at(x + 1, y), at(x + 1, y + 1));
      add_triangle(mesh, at(x, y), at(x + 1, y + 1), at(x, y + 1));
    }
}

}  // namespace

TriangleMesh sphere(int segments, double noise) {
  TriangleMesh mesh;
  std::mt19937 random(7);
  const int rows = segments / 2;
  const auto radius = [&] { return 1 + noise * (random() / 4294967296.0 - 0.5); };
  for (int y = 1; y < rows; ++y)
    for (int x = 0; x < segments; ++x) {
      const double u = 2 * std::numbers::pi * x / segments, v = std::numbers::pi * y / rows;
      mesh.positions.push_back(radius() * glm::dvec3(std::sin(v) * std::cos(u),
                                                     std::sin(v) * std::sin(u), -std::cos(v)));
    }
  add_cells(mesh, segments, rows - 1, false);
  const auto south = static_cast<std::uint32_t>(mesh.positions.size()), north = south + 1;
  mesh.positions.push_back({0, 0, -radius()});
  mesh.positions.push_back({0, 0, radius()});
  for (int x = 0; x < segments; ++x) {
    const auto next = static_cast<std::uint32_t>((x + 1) % segments), top = south - segments;
    add_triangle(mesh, south, next, x);
    add_triangle(mesh, north, top + x, top + next);
  }
  return mesh;
}

TriangleMesh torus(int segments) {
  TriangleMesh mesh;
  const int rows = segments / 2;
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < segments; ++x) {
      const double u = 2 * std::numbers::pi * x / segments, v = 2 * std::numbers::pi * y / rows;
      const double r = 1 + 0.4 * std::cos(v);
      mesh.positions.push_back({r * std::cos(u), r * std::sin(u), 0.4 * std::sin(v)});
    }
  add_cells(mesh, segments, rows, true);
  return mesh;
}

TriangleMesh open_grid(int cells, double height) {
  TriangleMesh mesh;
  const int side = cells + 1;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const double u = double(x) / cells, v = double(y) / cells;
      mesh.positions.push_back({u, v, height * std::sin(5 * u) * std::cos(4 * v)});
    }
  for (int y = 0; y < cells; ++y)
    for (int x = 0; x < cells; ++x) {
      const auto a = static_cast<std::uint32_t>(y * side + x), above = a + side;
      add_triangle(mesh, a, a + 1, above + 1);
      add_triangle(mesh, a, above + 1, above);
    }
  for (const auto v : mesh.triangles)
    mesh.corner_uvs.push_back(glm::vec2(0.05) + 0.9f * glm::vec2(mesh.positions[v]));
  return mesh;
}

TriangleMesh grid_with_fins(int cells) {
  TriangleMesh mesh = open_grid(cells);
  mesh.corner_uvs.clear();
  const auto side = static_cast<std::uint32_t>(cells + 1);
  for (std::uint32_t i = 0; i < 4; ++i) {
    const std::uint32_t a = (i + 2) * side + i + 1;
    mesh.positions.push_back(mesh.positions[a] + glm::dvec3(0.02, 0.03, 0.3));
    add_triangle(mesh, a, a + 1, static_cast<std::uint32_t>(mesh.positions.size() - 1));
    if (i % 2 == 0)
      add_triangle(mesh, a + 1, a, static_cast<std::uint32_t>(mesh.positions.size() - 1));
  }
  return mesh;
}

TriangleMesh slivers(int count) {
  TriangleMesh mesh;
  mesh.positions.push_back({0, 0, 0});
  for (int i = 0; i <= count; ++i) {
    const double angle = 0.001 * i;
    mesh.positions.push_back({std::cos(angle), std::sin(angle), 0.05 * std::sin(100 * angle)});
  }
  for (int i = 0; i < count; ++i)
    add_triangle(mesh, 0, static_cast<std::uint32_t>(i + 1), static_cast<std::uint32_t>(i + 2));
  return mesh;
}

TriangleMesh cube_with_face_charts() {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.positions.push_back({double(i & 1), double(i >> 1 & 1), double(i >> 2 & 1)});
  const std::uint32_t faces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                     {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (int f = 0; f < 6; ++f) {
    const glm::vec2 corner((f % 3) * 0.33f + 0.01f, (f / 3) * 0.5f + 0.02f);
    const glm::vec2 uvs[4] = {corner, corner + glm::vec2(0.3f, 0), corner + glm::vec2(0.3f),
                              corner + glm::vec2(0, 0.3f)};
    for (const int k : {0, 1, 2, 0, 2, 3}) {
      mesh.triangles.push_back(faces[f][k]);
      mesh.corner_uvs.push_back(uvs[k]);
    }
  }
  return mesh;
}

TriangleMesh flipped_and_duplicate(int cells) {
  TriangleMesh mesh = open_grid(cells);
  mesh.corner_uvs.clear();
  for (std::size_t t = 0; t < mesh.triangle_count(); t += 7)
    std::swap(mesh.triangles[3 * t], mesh.triangles[3 * t + 1]);
  for (std::size_t t = 3; t < 12; t += 3)
    add_triangle(mesh, mesh.triangles[3 * t], mesh.triangles[3 * t + 1], mesh.triangles[3 * t + 2]);
  add_triangle(mesh, 0, 1, 1);
  return mesh;
}

TriangleMesh separate_triangles(int count) {
  TriangleMesh mesh;
  for (int i = 0; i < count; ++i) {
    const glm::dvec3 corner(i % 10, i / 10, 0.1 * (i % 3));
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const auto& p : {glm::dvec3(0), glm::dvec3(0.5, 0.1, 0.2), glm::dvec3(0.1, 0.6, 0)})
      mesh.positions.push_back(corner + p);
    add_triangle(mesh, first, first + 1, first + 2);
  }
  return mesh;
}

TriangleMesh transformed(TriangleMesh mesh, double scale, const glm::dvec3& offset) {
  for (auto& p : mesh.positions) p = p * scale + offset;
  return mesh;
}

TriangleMesh cubes(int count) {
  constexpr std::array<std::array<std::uint32_t, 4>, 6> kSides{
      {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
  TriangleMesh mesh;
  for (int i = 0; i < count; ++i) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const glm::dvec3 corner(2.5 * (i % 10), 2.5 * (i / 10), 0);
    for (int k = 0; k < 8; ++k)
      mesh.positions.push_back(corner + glm::dvec3(k & 1, k >> 1 & 1, k >> 2 & 1));
    for (const auto& side : kSides) {
      add_triangle(mesh, first + side[0], first + side[1], first + side[2]);
      add_triangle(mesh, first + side[0], first + side[2], first + side[3]);
    }
  }
  return mesh;
}

TriangleMesh gear(int teeth) {
  TriangleMesh mesh;
  const auto columns = static_cast<std::uint32_t>(4 * teeth);
  // There are four rings: the outer and inner rims of the bottom, then those of the top. Caps
  // connect outer and inner rims. Walls connect bottom and top.
  for (int ring = 0; ring < 4; ++ring)
    for (std::uint32_t i = 0; i < columns; ++i) {
      const double angle = 2 * std::numbers::pi * i / columns;
      const double radius = ring % 2 == 1 ? 0.4 : i % 4 < 2 ? 1 : 0.8;
      mesh.positions.push_back(
          {radius * std::cos(angle), radius * std::sin(angle), ring < 2 ? 0 : 0.3});
    }
  const auto quads = [&](std::uint32_t from, std::uint32_t to) {
    for (std::uint32_t i = 0; i < columns; ++i) {
      const std::uint32_t next = (i + 1) % columns;
      add_triangle(mesh, from * columns + i, from * columns + next, to * columns + next);
      add_triangle(mesh, from * columns + i, to * columns + next, to * columns + i);
    }
  };
  quads(0, 2), quads(2, 3), quads(3, 1), quads(1, 0);
  return mesh;
}

TriangleMesh flat_ring(int sides) {
  TriangleMesh mesh;
  for (int i = 0; i < sides; ++i) {
    const double angle = 2 * std::numbers::pi * i / sides;
    for (const double radius : {1.0, 0.92})
      mesh.positions.push_back({radius * std::cos(angle), 0.5, radius * std::sin(angle)});
  }
  const auto count = static_cast<std::uint32_t>(2 * sides);
  for (std::uint32_t i = 0; i < count; i += 2) {
    add_triangle(mesh, i, i + 1, (i + 2) % count);
    add_triangle(mesh, i + 1, (i + 3) % count, (i + 2) % count);
  }
  return mesh;
}

TriangleMesh strips(int count, double length) {
  TriangleMesh mesh;
  for (int i = 0; i < count; ++i) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const double angle = 0.1 * i;
    const glm::dvec3 origin(3.0 * i, 0, 0), across(std::cos(angle), std::sin(angle), 0),
        along(0, 0, length);
    mesh.positions.insert(mesh.positions.end(),
                          {origin, origin + across, origin + across + along, origin + along});
    add_triangle(mesh, first, first + 1, first + 2);
    add_triangle(mesh, first, first + 2, first + 3);
  }
  return mesh;
}

std::vector<NamedMesh> mesh_classes() {
  return {{"sphere", sphere(40)},
          {"noisy_sphere", sphere(60, 0.08)},
          {"torus", torus(40)},
          {"open_grid", open_grid(16)},
          {"grid_with_fins", grid_with_fins(12)},
          {"slivers", slivers(300)},
          {"cube", cube_with_face_charts()},
          {"flipped_and_duplicate", flipped_and_duplicate(10)},
          {"separate_triangles", separate_triangles(40)},
          {"cubes", cubes(12)},
          {"gear", gear(12)},
          {"flat_ring", flat_ring(66)},
          {"strips", strips(12, 40)}};
}

}  // namespace strata::test
