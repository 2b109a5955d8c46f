#include "app/photographs/seeing.h"

#include <algorithm>
#include <cmath>

#include "mesh/surface/search_tree.h"

namespace strata::app {
namespace {

constexpr double kLineTolerance = 1e-4, kBoxTolerance = 1e-5;
constexpr double kStepOfDistance = 1e-6;  // for the derivative of the projection

// Returns the length at the place that covers one pixel: the square root of the area of a pixel,
// across the direction of view. Returns nothing where the projection has no derivative.
std::optional<double> length_of_pixel(const photo::Camera& camera, const photo::Pose& pose,
                                      const glm::dvec3& place, const glm::dvec2& pixel,
                                      const glm::dvec3& toward_camera, double distance) {
  const glm::dvec3 other =
      std::abs(toward_camera.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 across = glm::normalize(glm::cross(toward_camera, other));
  const glm::dvec3 along = glm::cross(toward_camera, across);
  const double step = kStepOfDistance * distance;
  const auto by_across = photo::project(camera, pose, place + across * step);
  const auto by_along = photo::project(camera, pose, place + along * step);
  if (!by_across || !by_along) return std::nullopt;
  const double area = std::abs(glm::determinant(glm::dmat2(*by_across - pixel, *by_along - pixel)));
  if (!(area > 0)) return std::nullopt;
  return step / std::sqrt(area);
}

}  // namespace

bool PlaceView::may_be_seen_from(const photo::Pose& pose) const {
  const glm::dvec3 from_center = place_.position - pose.center;
  return glm::dot(place_.normal, from_center) < 0 && (pose.camera_from_world * from_center).z > 0;
}

std::optional<PlaceInPhotograph> PlaceView::in(const photo::Camera& camera,
                                               const photo::Pose& pose) const {
  if (!may_be_seen_from(pose)) return std::nullopt;
  const auto pixel = photo::project(camera, pose, place_.position);
  if (!pixel || !photo::is_inside(camera, *pixel)) return std::nullopt;
  PlaceInPhotograph seen;
  seen.pixel = *pixel;
  const glm::dvec3 to_camera = pose.center - place_.position;
  const glm::dvec3 local = pose.camera_from_world * -to_camera;
  seen.direction = glm::dvec2(local) / local.z;
  seen.distance = glm::length(to_camera);
  seen.cos_angle = glm::dot(place_.normal, to_camera) / seen.distance;
  const auto length = length_of_pixel(camera, pose, place_.position, *pixel,
                                      to_camera / seen.distance, seen.distance);
  if (!length || !(seen.cos_angle > 0) || is_hidden_from(pose.center, seen.distance))
    return std::nullopt;
  seen.units_per_pixel = *length;
  return seen;
}

bool PlaceView::is_hidden_from(const glm::dvec3& center, double distance) const {
  const glm::dvec3 direction = (place_.position - center) / distance;
  // Begin at the box of the model, because a distant start would be rounded too much.
  const double skipped = std::max(0.0, distance - diagonal_);
  const glm::vec3 start(center + direction * skipped - origin_);
  const auto hit = tree_.first_hit(start, glm::vec3(direction));
  return hit &&
         skipped + hit->distance < distance - kLineTolerance * distance - kBoxTolerance * diagonal_;
}

}  // namespace strata::app
