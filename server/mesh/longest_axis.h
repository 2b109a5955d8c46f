#pragma once

#include <glm/glm.hpp>

namespace strata::mesh {

// Returns the axis (0, 1 or 2) of the largest component. If several components are equally large,
// returns the first of their axes. `extent` has no negative component.
inline int longest_axis(const glm::vec3& extent) {
  return extent.x >= extent.y ? (extent.x >= extent.z ? 0 : 2) : (extent.y >= extent.z ? 1 : 2);
}

}  // namespace strata::mesh
