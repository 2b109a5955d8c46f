#pragma once

#include <cmath>
#include <glm/glm.hpp>

namespace strata::mesh {

// A right-handed coordinate system with the given unit vector as its z axis.
struct TangentFrame {
  explicit TangentFrame(const glm::dvec3& up) : z(up) {
    const glm::dvec3 other = std::abs(z.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    x = glm::normalize(glm::cross(other, z));
    y = glm::cross(z, x);
  }
  glm::dvec3 x, y, z;
};

}  // namespace strata::mesh
