#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/glm.hpp>
#include <map>
#include <string>
#include <tuple>

#include "support/surfaces.h"

// Shapes with formulas for distances, whose atlases are cut in a chosen way.
namespace strata::test {

// A surface over a rectangle of two parameters, made of cells of two triangles each.
struct Shape {
  int columns = 128, rows = 128;
  std::function<glm::dvec3(double s, double t)> position;  // s, t: 0…1
  std::function<glm::dvec2(double s, double t)> flat;      // in a plane, almost without distortion
};

// The cuts of an atlas into columns × rows charts. Neighboring charts differ in scale and
// direction.
struct Cuts {
  int columns = 1, rows = 1;
  double turn = 0.7;    // radians from one chart to the next
  double scale = 0.75;  // every second chart is smaller by this factor
};

inline Surface cut_surface(const Shape& shape, const Cuts& cuts, int resolution) {
  mesh::TriangleMesh mesh;
  mesh::Atlas atlas;
  std::map<std::tuple<long, long, long>, std::uint32_t> welded;
  const auto vertex = [&](double s, double t) {
    const glm::dvec3 p = shape.position(s, t);
    const auto key =
        std::tuple{std::lround(p.x * 1e7), std::lround(p.y * 1e7), std::lround(p.z * 1e7)};
    const auto [found, fresh] =
        welded.try_emplace(key, static_cast<std::uint32_t>(mesh.positions.size()));
    if (fresh) mesh.positions.push_back(p);
    return found->second;
  };
  // Each chart is in a square of the atlas.
  const int side = static_cast<int>(std::ceil(std::sqrt(cuts.columns * cuts.rows)));
  double widest = 0;
  const auto center_of = [&](int column, int row) {
    return shape.flat((column + 0.5) / cuts.columns, (row + 0.5) / cuts.rows);
  };
  const auto column_of = [&](int x) { return x * cuts.columns / shape.columns; };
  const auto row_of = [&](int y) { return y * cuts.rows / shape.rows; };
  for (int y = 0; y <= shape.rows; ++y)
    for (int x = 0; x <= shape.columns; ++x)
      for (const int dx : {-1, 0})
        for (const int dy : {-1, 0}) {
          const int cx = std::clamp(x + dx, 0, shape.columns - 1),
                    cy = std::clamp(y + dy, 0, shape.rows - 1);
          widest = std::max(
              widest, glm::length(shape.flat(double(x) / shape.columns, double(y) / shape.rows) -
                                  center_of(column_of(cx), row_of(cy))));
        }
  const auto uv = [&](int cell_x, int cell_y, int x, int y) {
    const int column = column_of(cell_x), row = row_of(cell_y), chart = row * cuts.columns + column;
    const int place_x = chart % side, place_y = chart / side;
    const double scale = (column + row) % 2 == 0 ? 1 : cuts.scale, turn = chart * cuts.turn;
    const glm::dvec2 at =
        scale * 0.47 / (side * widest) *
        (shape.flat(double(x) / shape.columns, double(y) / shape.rows) - center_of(column, row));
    return glm::vec2((place_x + 0.5) / side + at.x * std::cos(turn) - at.y * std::sin(turn),
                     (place_y + 0.5) / side + at.x * std::sin(turn) + at.y * std::cos(turn));
  };
  for (int y = 0; y < shape.rows; ++y)
    for (int x = 0; x < shape.columns; ++x) {
      const int corners[6][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}};
      for (int triangle = 0; triangle < 2; ++triangle) {
        std::uint32_t index[3];
        for (int k = 0; k < 3; ++k) {
          const auto& corner = corners[3 * triangle + k];
          index[k] =
              vertex(double(x + corner[0]) / shape.columns, double(y + corner[1]) / shape.rows);
        }
        if (index[0] == index[1] || index[1] == index[2] || index[2] == index[0]) continue;
        for (int k = 0; k < 3; ++k) {
          const auto& corner = corners[3 * triangle + k];
          mesh.triangles.push_back(index[k]);
          atlas.corner_uvs.push_back(uv(x, y, x + corner[0], y + corner[1]));
        }
      }
    }
  Progress progress;
  Surface surface;
  surface.geometry = mesh::build_geometry(mesh, atlas);
  surface.map = *mesh::bake_surface_map(surface.geometry, resolution, progress);
  surface.graph = *mesh::build_texel_graph(surface.geometry, surface.map, progress);
  return surface;
}

}  // namespace strata::test
