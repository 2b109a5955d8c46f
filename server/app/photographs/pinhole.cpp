#include "app/photographs/pinhole.h"

#include <algorithm>
#include <cmath>
#include <glm/ext/matrix_clip_space.hpp>
#include <limits>

namespace strata::app {
namespace {

constexpr int kBorderSteps = 32;  // per side; distortion is smooth
constexpr double kNearOfFar = 1e-3;
constexpr double kMargin = 1.01;  // of the near and far planes

}  // namespace

Result<Pinhole> pinhole_of(const photo::Camera& camera) {
  const photo::Pose axes;
  const double limit = std::min(kMaxPinholeTangent, camera.valid_radius);
  glm::dvec2 low(std::numeric_limits<double>::max()), high(-low);
  const auto include = [&](const glm::dvec2& pixel) {
    glm::dvec2 direction;
    if (const auto ray = photo::ray_through(camera, axes, pixel); ray && ray->direction.z > 0)
      direction = glm::dvec2(ray->direction) / ray->direction.z;
    else  // outside the valid part of the lens
      direction = limit * glm::normalize(pixel - camera.principal_point);
    direction = glm::clamp(direction, -limit, limit);
    low = glm::min(low, direction);
    high = glm::max(high, direction);
  };
  for (int i = 0; i <= kBorderSteps; ++i) {
    const double x = camera.width * i / double{kBorderSteps};
    const double y = camera.height * i / double{kBorderSteps};
    include({x, 0});
    include({x, camera.height});
    include({0, y});
    include({camera.width, y});
  }
  const glm::dvec2 size = high - low;
  const double pixels_per_unit = std::sqrt(camera.focal.x * camera.focal.y);
  const glm::dvec2 pixels = size * pixels_per_unit;
  if (!(std::min(pixels.x, pixels.y) > 0) || !std::isfinite(pixels.x) || !std::isfinite(pixels.y))
    return fail(ErrorCode::invalid, "Picture outside the lens",
                "The photograph shows no direction in which its calibration is valid. Check the "
                "calibration in the program that exported it.");
  const double scale = std::min(1.0, kMaxUndistortedSide / std::max(pixels.x, pixels.y));
  const auto side = [scale](double length) {
    return std::clamp(static_cast<int>(std::lround(length * scale)), 1, kMaxUndistortedSide);
  };
  return Pinhole{low.x, high.x, low.y, high.y, side(pixels.x), side(pixels.y)};
}

glm::dvec2 pixel_of(const Pinhole& pinhole, const glm::dvec2& direction) {
  return {(direction.x - pinhole.left) / (pinhole.right - pinhole.left) * pinhole.width,
          (direction.y - pinhole.top) / (pinhole.bottom - pinhole.top) * pinhole.height};
}

glm::dvec2 direction_of(const Pinhole& pinhole, const glm::dvec2& pixel) {
  return {pinhole.left + pixel.x / pinhole.width * (pinhole.right - pinhole.left),
          pinhole.top + pixel.y / pinhole.height * (pinhole.bottom - pinhole.top)};
}

Camera view_of(const Pinhole& pinhole, const photo::Pose& pose, const glm::dvec3& box_min,
               const glm::dvec3& box_max) {
  // The axes of views have y up and z toward the viewer.
  const glm::dmat3 rotation = glm::dmat3(1, 0, 0, 0, -1, 0, 0, 0, -1) * pose.camera_from_world;
  Camera camera;
  camera.width = pinhole.width;
  camera.height = pinhole.height;
  camera.view = glm::dmat4(rotation);
  camera.view[3] = glm::dvec4(-(rotation * pose.center), 1);

  double nearest = std::numeric_limits<double>::max(), farthest = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 point((corner & 1) != 0 ? box_max.x : box_min.x,
                           (corner & 2) != 0 ? box_max.y : box_min.y,
                           (corner & 4) != 0 ? box_max.z : box_min.z);
    const double depth = (pose.camera_from_world * (point - pose.center)).z;
    nearest = std::min(nearest, depth);
    farthest = std::max(farthest, depth);
  }
  // A camera that looks away from the model sees nothing, but must still have a projection.
  const double far = farthest > 0 ? farthest * kMargin : 1;
  const double near = std::max(std::min(nearest / kMargin, far / 2), far * kNearOfFar);
  // The window is in the plane z = 1, and its y points down.
  camera.projection = glm::frustum(near * pinhole.left, near * pinhole.right,
                                   -near * pinhole.bottom, -near * pinhole.top, near, far);
  return camera;
}

}  // namespace strata::app
