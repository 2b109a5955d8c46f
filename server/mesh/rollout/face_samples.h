#pragma once

#include <glm/glm.hpp>

#include "domain/people/question.h"
#include "mesh/surface/geometry.h"

namespace strata::mesh {

// Faces at a smaller angle to the axis than about 20° are floors, lids and rims.
inline constexpr double kFloorCosine = 0.94;
inline constexpr std::size_t kTrianglesAtOnce = 1u << 16;  // between two checks of the question

// A triangle or patch as a sample of the surface.
struct FaceSample {
  glm::dvec3 place;  // its middle, relative to a center
  glm::dvec3 normal;
  double area;
};

// Calls `see` with each triangle that has an area. The places are relative to `center`, in world
// directions. Checks the current question.
template <class See>
void for_each_face(const Geometry& geometry, const glm::dvec3& center, See see) {
  for (std::size_t t = 0; t < geometry.triangle_count(); ++t) {
    if (t % kTrianglesAtOnce == 0) check_question();
    const auto at = [&](std::size_t k) {
      return geometry.positions[geometry.vertices[geometry.indices[3 * t + k]].position_index];
    };
    const glm::dvec3 a = at(0), b = at(1), c = at(2);
    const glm::dvec3 cross = glm::cross(b - a, c - a);
    const double twice = glm::length(cross);
    if (twice > 0) see(FaceSample{(a + b + c) / 3.0 - center, cross / twice, twice / 2});
  }
}

}  // namespace strata::mesh
