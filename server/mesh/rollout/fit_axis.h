#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "mesh/surface/geometry.h"

namespace strata::mesh {

struct FittedAxis {
  glm::dvec3 point{0};      // in world coordinates
  glm::dvec3 direction{0};  // a unit vector of either sense
};

// Fits the axis of a surface of revolution. The normals of such a surface meet its axis, which
// gives the axis by linear least squares, weighted by area (Pottmann and Randrup, Rotational and
// helical surface approximation for reverse engineering, Computing 60, 1998). This also holds for
// walls with two sides, for floors and for bellied vessels. Reduces the weight of triangles that
// fit badly, such as handles. Returns nullopt if the model has no unique axis: it is similar to a
// sphere or cube, or it is flat. Checks the current question.
std::optional<FittedAxis> fit_revolution_axis(const Geometry& geometry);

// Fits the axis of a general cylinder. Its normals are perpendicular to the direction of the axis.
// The axis passes through the point of the cross section that is nearest to the lines along the
// normals. So it is in the middle of a pillar, and near the springing line of a vault. End walls
// and other faces across the axis have little weight. Returns nullopt and checks as above.
std::optional<FittedAxis> fit_cylinder_axis(const Geometry& geometry);

}  // namespace strata::mesh
