#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "core/model.h"

namespace strata::mesh {

// A mesh as files give it: plain arrays, double coordinates in world units. No GL, no connectivity.
struct TriangleMesh {
  std::vector<glm::dvec3> positions;
  std::vector<std::uint32_t> triangles;      // 3 position indices a triangle
  std::vector<glm::vec2> corner_uvs;         // empty, or 3 a triangle; uv origin lower left
  std::vector<std::uint32_t> vertex_colors;  // empty, or RGBA8 (red in the low byte) a position

  std::size_t triangle_count() const { return triangles.size() / 3; }
};

// Sum of triangle areas, unit².
double surface_area(const TriangleMesh& mesh);

}  // namespace strata::mesh
