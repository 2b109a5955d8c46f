#include "mesh/rollout/developed_surface.h"

#include <cmath>

namespace strata::mesh {

double DevelopedSurface::radius_at(double slant) const {
  return radius + slant * std::sin(half_angle);
}

double DevelopedSurface::apex() const { return -radius / std::sin(half_angle); }

glm::dvec3 DevelopedSurface::radial(double angle) const {
  return std::cos(angle) * zero + std::sin(angle) * glm::cross(axis, zero);
}

glm::dvec3 DevelopedSurface::tangent(double angle) const {
  return -std::sin(angle) * zero + std::cos(angle) * glm::cross(axis, zero);
}

glm::dvec3 DevelopedSurface::generator(double angle) const {
  return std::sin(half_angle) * radial(angle) + std::cos(half_angle) * axis;
}

glm::dvec3 DevelopedSurface::normal(double angle) const {
  return std::cos(half_angle) * radial(angle) - std::sin(half_angle) * axis;
}

glm::dvec3 DevelopedSurface::at(double angle, double slant) const {
  return point + radius * radial(angle) + slant * generator(angle);
}

DevelopedSurface::Place DevelopedSurface::place_of(const glm::dvec3& world) const {
  const glm::dvec3 from_point = world - point;
  const double along = glm::dot(from_point, axis);
  const double x = glm::dot(from_point, zero), y = glm::dot(from_point, glm::cross(axis, zero));
  const double beyond = std::hypot(x, y) - radius;
  const double sine = std::sin(half_angle), cosine = std::cos(half_angle);
  return {std::atan2(y, x), beyond * sine + along * cosine, beyond * cosine - along * sine};
}

}  // namespace strata::mesh
