#include "media/photographs/camera.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace strata::photo {
namespace {

constexpr double kMaxLength = 1e9;  // pixels or sides

std::string size_text(int width, int height) {
  return std::to_string(width) + " × " + std::to_string(height) + " pixels";
}

tl::unexpected<Error> wrong(std::string detail) {
  return fail(ErrorCode::invalid, "Camera not usable", std::move(detail));
}

bool is_side(int side) { return side > 0 && side <= kMaxPhotographSide; }

}  // namespace

Result<void> check(const Calibration& calibration) {
  const auto is_bounded_length = [](double length) { return std::abs(length) <= kMaxLength; };
  const bool has_size = calibration.width != 0 || calibration.height != 0;
  if (has_size && !(is_side(calibration.width) && is_side(calibration.height)))
    return wrong("The width and the height of a photograph must be from 1 to " +
                 std::to_string(kMaxPhotographSide) + " pixels.");
  if (!(calibration.focal.x > 0 && calibration.focal.y > 0) ||
      !is_bounded_length(calibration.focal.x) || !is_bounded_length(calibration.focal.y))
    return wrong("The focal length must be a positive number.");
  if (!is_bounded_length(calibration.offset.x) || !is_bounded_length(calibration.offset.y) ||
      !is_bounded_length(calibration.skew))
    return wrong("The principal point must be finite numbers near the photograph.");
  if (!is_bounded(calibration.lens))
    return wrong("The coefficients of the lens must be finite numbers.");
  return {};
}

Result<Camera> camera_for(const Calibration& calibration, int width, int height) {
  STRATA_TRY(check(calibration));
  if (!is_side(width) || !is_side(height))
    return wrong("A photograph of " + size_text(width, height) + " cannot have a camera.");
  glm::dvec2 scale(1);
  if (calibration.unit == CalibrationUnit::longest_side)
    scale = glm::dvec2(std::max(width, height));
  if (calibration.width != 0) {
    const double by_width = static_cast<double>(width) * calibration.height / calibration.width;
    const double by_height = static_cast<double>(height) * calibration.width / calibration.height;
    if (std::abs(by_width - height) > 1 && std::abs(by_height - width) > 1)
      return wrong("The photograph has " + size_text(width, height) + ", but its camera has " +
                   size_text(calibration.width, calibration.height) +
                   ". Use the photograph with which the cameras were aligned, neither cropped nor "
                   "turned.");
    if (calibration.unit == CalibrationUnit::pixel)
      scale = {static_cast<double>(width) / calibration.width,
               static_cast<double>(height) / calibration.height};
  }
  Camera camera;
  camera.width = width;
  camera.height = height;
  camera.focal = calibration.focal * scale;
  camera.principal_point = calibration.offset * scale + glm::dvec2(width, height) / 2.0;
  camera.skew = calibration.skew * scale.x;
  camera.lens = calibration.lens;
  camera.valid_radius = valid_radius(calibration.lens);
  return camera;
}

std::optional<glm::dvec2> project(const Camera& camera, const Pose& pose, const glm::dvec3& world) {
  const glm::dvec3 local = pose.camera_from_world * (world - pose.center);
  if (!(local.z > 0)) return std::nullopt;
  const glm::dvec2 direction = glm::dvec2(local) / local.z;
  if (!(glm::length(direction) <= camera.valid_radius)) return std::nullopt;
  const auto [point, jacobian] = distort(camera.lens, direction);
  if (!(glm::determinant(jacobian) > 0)) return std::nullopt;
  return camera.focal * point + glm::dvec2(camera.skew * point.y, 0) + camera.principal_point;
}

std::optional<Ray> ray_through(const Camera& camera, const Pose& pose, const glm::dvec2& pixel) {
  const glm::dvec2 from_center = pixel - camera.principal_point;
  glm::dvec2 point;
  point.y = from_center.y / camera.focal.y;
  point.x = (from_center.x - camera.skew * point.y) / camera.focal.x;
  const double pixels_per_unit = std::max(camera.focal.x, camera.focal.y) + std::abs(camera.skew);
  const auto direction =
      undistort(camera.lens, camera.valid_radius, point, kMaxRayError / 2 / pixels_per_unit);
  if (!direction) return std::nullopt;
  const glm::dvec3 local = glm::normalize(glm::dvec3(*direction, 1));
  const Ray ray{pose.center, glm::transpose(pose.camera_from_world) * local};
  const auto back = project(camera, {pose.camera_from_world, glm::dvec3(0)}, ray.direction);
  if (!back || !(glm::length(*back - pixel) <= kMaxRayError)) return std::nullopt;
  return ray;
}

}  // namespace strata::photo
