#pragma once

#include <glm/glm.hpp>

namespace strata::mesh {

// Of a vector without negative components: 0, 1 or 2, the first of equals.
inline int longest_axis(const glm::vec3& extent) {
  return extent.x >= extent.y ? (extent.x >= extent.z ? 0 : 2) : (extent.y >= extent.z ? 1 : 2);
}

}  // namespace strata::mesh
