#pragma once

#include <glm/glm.hpp>
#include <numbers>
#include <vector>

namespace strata::mesh {

inline constexpr double kTurn = 2 * std::numbers::pi;
inline constexpr double kAngleRounding = 1e-9;

// The cross section of a general cylinder: a closed polygon around the axis that each ray from the
// axis meets exactly once. Angles are in radians, counterclockwise, and may exceed a turn.
class CrossSection {
 public:
  // `radii` are the distances of the corners from the axis at equal steps of the angle, beginning
  // with the angle 0. They must be positive, and at least 8.
  explicit CrossSection(std::vector<double> radii);

  const std::vector<double>& radii() const { return radii_; }
  double length() const { return arcs_.back(); }  // of the whole polygon
  double radius(double angle) const;
  // Returns the length of the polygon from the angle 0 to an angle. Grows with the angle.
  double arc(double angle) const;
  double angle_at(double arc) const;  // the inverse of arc()
  // Returns the direction of growing angles as a unit vector: x toward the angle 0. It changes
  // continuously, so the relief of a rollout shows no edges between the sides of the polygon.
  glm::dvec2 tangent(double angle) const;
  // The smallest and the largest length per radian.
  double min_stretch() const { return min_stretch_; }
  double max_stretch() const { return max_stretch_; }

 private:
  // A place on the side that begins at a corner.
  struct OnSide {
    std::size_t corner = 0;
    double share = 0;  // from this corner to the next
    double turns = 0;  // whole turns before
  };
  OnSide at(double angle) const;
  glm::dvec2 corner(std::size_t i) const;          // any i
  glm::dvec2 corner_tangent(std::size_t i) const;  // any i

  std::vector<double> radii_;
  std::vector<double> arcs_;  // up to each corner; the last one is the whole length
  double min_stretch_ = 0, max_stretch_ = 0;
};

}  // namespace strata::mesh
