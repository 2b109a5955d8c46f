#pragma once

#include <glm/glm.hpp>
#include <memory>

#include "mesh/rollout/cross_section.h"

namespace strata::mesh {

enum class DevelopedShape { cylinder, cone, general_cylinder };

// A surface around an axis that can be unrolled onto a plane without distortion: a circular
// cylinder, a circular cone, or a general cylinder with any cross section. In world coordinates and
// model units. A place near it has three coordinates:
// - `angle` in radians: the direction from the axis, counterclockwise when seen against the axis
// - `slant`: the length along the straight line with this angle, 0 in the plane of `point`
// - `height`: the distance from the surface, positive outside; for a general cylinder in the
//   direction from the axis
struct DevelopedSurface {
  struct Place {
    double angle = 0, slant = 0, height = 0;
  };

  glm::dvec3 point{0};       // on the axis
  glm::dvec3 axis{0, 0, 1};  // unit vector
  glm::dvec3 zero{1, 0,
                  0};  // the direction of the angle 0, a unit vector perpendicular to the axis
  // In the plane through `point` that is perpendicular to the axis. Of a general cylinder: of the
  // circle with the same circumference.
  double radius = 1;
  // Between the axis and the straight lines of the surface, in radians, less than a right angle.
  // 0: a cylinder. Positive: the radius grows along the axis.
  double half_angle = 0;
  std::shared_ptr<const CrossSection> section{};  // only of a general cylinder

  DevelopedShape shape() const;
  bool is_cone() const { return half_angle != 0; }
  double radius_at(double angle, double slant) const;
  // Returns the length around the axis of a cylinder or general cylinder from the angle 0 to an
  // angle.
  double arc(double angle) const;
  // The smallest and the largest length around the axis at this slant per radian.
  double min_stretch(double slant) const;
  double max_stretch(double slant) const;
  double apex() const;  // the slant of the tip of a cone
  glm::dvec3 radial(double angle) const;
  glm::dvec3 tangent(double angle) const;    // in the direction of growing angles
  glm::dvec3 generator(double angle) const;  // in the direction of growing slants
  glm::dvec3 normal(double angle) const;     // outward
  // Returns the direction in which a rollout shows the surface, outward. It meets the axis: it is
  // the normal, but for a general cylinder the direction from the axis.
  glm::dvec3 ray(double angle) const;
  double to_axis(double angle, double slant) const;  // along the ray
  glm::dvec3 at(double angle, double slant) const;
  Place place_of(const glm::dvec3& world) const;  // with an angle from −π to π
};

}  // namespace strata::mesh
