#pragma once

#include <glm/glm.hpp>

namespace strata::mesh {

// A cylinder or a circular cone, which can be unrolled onto a plane without distortion. In world
// coordinates and model units. A place near it has three coordinates:
// - `angle` in radians: the direction from the axis, counterclockwise when seen against the axis
// - `slant`: the length along the straight line with this angle, 0 in the plane of `point`
// - `height`: the distance from the surface, positive outside
struct DevelopedSurface {
  struct Place {
    double angle = 0, slant = 0, height = 0;
  };

  glm::dvec3 point{0};       // on the axis
  glm::dvec3 axis{0, 0, 1};  // unit vector
  glm::dvec3 zero{1, 0,
                  0};  // the direction of the angle 0, a unit vector perpendicular to the axis
  double radius = 1;   // in the plane through `point` that is perpendicular to the axis
  // Between the axis and the straight lines of the surface, in radians, less than a right angle.
  // 0: a cylinder. Positive: the radius grows along the axis.
  double half_angle = 0;

  bool is_cone() const { return half_angle != 0; }
  double radius_at(double slant) const;
  double apex() const;  // the slant of the tip of a cone
  glm::dvec3 radial(double angle) const;
  glm::dvec3 tangent(double angle) const;    // in the direction of growing angles
  glm::dvec3 generator(double angle) const;  // in the direction of growing slants
  glm::dvec3 normal(double angle) const;     // outward
  glm::dvec3 at(double angle, double slant) const;
  Place place_of(const glm::dvec3& world) const;  // with an angle from −π to π
};

}  // namespace strata::mesh
