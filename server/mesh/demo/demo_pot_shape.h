#pragma once

#include <cstdint>
#include <glm/glm.hpp>

namespace strata::mesh {

// The shape of the demo pot without its mesh: the position and color of its surface. Lengths are in
// mm, angles in radians, and +z is up. The final scaling to the stated size is not applied.
class DemoPotShape {
 public:
  // The surface from the center of the underside to the center of the inside floor, in five
  // stretches. `t` runs from 0 to 1 in each stretch.
  enum class Stretch { underside_and_belly, shoulder_and_neck, rim, inside_upper, inside_lower };

  struct Point {
    glm::dvec3 position;
    std::uint32_t color;  // RGBA8, red in the low byte
  };
  static Point at(Stretch stretch, double t, double angle);

  // Returns the distance from the axis before relief and wobble. It determines the number of
  // columns of a ring.
  static double radius(Stretch stretch, double t);
};

}  // namespace strata::mesh
