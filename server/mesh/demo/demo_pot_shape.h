#pragma once

#include <cstdint>
#include <glm/glm.hpp>

namespace strata::mesh {

// The form of the demo pot without its mesh: position and color of its surface. Lengths in mm,
// angles in radians, +z up, before the final scaling to the stated size.
class DemoPotShape {
 public:
  // The surface from the middle of the underside to the middle of the inside floor, in five
  // stretches. `t` is 0…1 in each.
  enum class Stretch { underside_and_belly, shoulder_and_neck, rim, inside_upper, inside_lower };

  struct Point {
    glm::dvec3 position;
    std::uint32_t color;  // RGBA8, red in the low byte
  };
  static Point at(Stretch stretch, double t, double angle);

  // Distance from the axis before relief and wobble; used to choose the number of columns of a
  // ring.
  static double radius(Stretch stretch, double t);
};

}  // namespace strata::mesh
