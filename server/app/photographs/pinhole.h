#pragma once

#include <glm/glm.hpp>

#include "domain/scene/camera.h"
#include "media/photographs/camera.h"

namespace strata::app {

constexpr int kMaxUndistortedSide = 4096;  // pixels
constexpr double kMaxPinholeTangent = 2;   // 63° from the axis

// The undistorted picture of a photograph: a window in the plane z = 1 of the camera's axes
// (media/photographs/camera.h), so y points down. It contains the whole photograph, apart from
// directions with a component above kMaxPinholeTangent and those outside the valid radius of the
// lens.
struct Pinhole {
  double left = 0, right = 0, top = 0, bottom = 0;
  int width = 0, height = 0;  // pixels; at most kMaxUndistortedSide
};

// Has as many pixels per radian at the axis as the photograph, but fewer if a side would be too
// long. Returns an `invalid` error for a photograph that has no pixel within the window.
Result<Pinhole> pinhole_of(const photo::Camera& camera);

// Returns the pixel of a direction (x, y, 1) in camera axes, also outside the picture.
glm::dvec2 pixel_of(const Pinhole& pinhole, const glm::dvec2& direction);
// The inverse of `pixel_of`.
glm::dvec2 direction_of(const Pinhole& pinhole, const glm::dvec2& pixel);

// Returns the camera of a view that shows the same picture. Its near and far planes enclose the
// part of the box that is in front of the camera. If the camera is in the box, the near plane is at
// a thousandth of the far plane.
Camera view_of(const Pinhole& pinhole, const photo::Pose& pose, const glm::dvec3& box_min,
               const glm::dvec3& box_max);

}  // namespace strata::app
