#include "mesh/rollout/developed_surface.h"

#include <cmath>

namespace strata::mesh {

DevelopedShape DevelopedSurface::shape() const {
  if (section) return DevelopedShape::general_cylinder;
  return is_cone() ? DevelopedShape::cone : DevelopedShape::cylinder;
}

double DevelopedSurface::radius_at(double angle, double slant) const {
  return section ? section->radius(angle) : radius + slant * std::sin(half_angle);
}

double DevelopedSurface::arc(double angle) const {
  return section ? section->arc(angle) : angle * radius;
}

double DevelopedSurface::min_stretch(double slant) const {
  return section ? section->min_stretch() : std::abs(radius_at(0, slant));
}

double DevelopedSurface::max_stretch(double slant) const {
  return section ? section->max_stretch() : std::abs(radius_at(0, slant));
}

double DevelopedSurface::apex() const { return -radius / std::sin(half_angle); }

glm::dvec3 DevelopedSurface::radial(double angle) const {
  return std::cos(angle) * zero + std::sin(angle) * glm::cross(axis, zero);
}

glm::dvec3 DevelopedSurface::tangent(double angle) const {
  const glm::dvec2 flat =
      section ? section->tangent(angle) : glm::dvec2(-std::sin(angle), std::cos(angle));
  return flat.x * zero + flat.y * glm::cross(axis, zero);
}

glm::dvec3 DevelopedSurface::generator(double angle) const {
  return std::sin(half_angle) * radial(angle) + std::cos(half_angle) * axis;
}

glm::dvec3 DevelopedSurface::normal(double angle) const {
  if (section) return glm::cross(tangent(angle), axis);
  return std::cos(half_angle) * radial(angle) - std::sin(half_angle) * axis;
}

glm::dvec3 DevelopedSurface::ray(double angle) const {
  return section ? radial(angle) : normal(angle);
}

double DevelopedSurface::to_axis(double angle, double slant) const {
  return radius_at(angle, slant) / std::cos(half_angle);
}

glm::dvec3 DevelopedSurface::at(double angle, double slant) const {
  return point + (section ? section->radius(angle) : radius) * radial(angle) +
         slant * generator(angle);
}

DevelopedSurface::Place DevelopedSurface::place_of(const glm::dvec3& world) const {
  const glm::dvec3 from_point = world - point;
  const double along = glm::dot(from_point, axis);
  const double x = glm::dot(from_point, zero), y = glm::dot(from_point, glm::cross(axis, zero));
  const double angle = std::atan2(y, x), to_axis = std::hypot(x, y);
  if (section) return {angle, along, to_axis - section->radius(angle)};
  const double beyond = to_axis - radius;
  const double sine = std::sin(half_angle), cosine = std::cos(half_angle);
  return {angle, beyond * sine + along * cosine, beyond * cosine - along * sine};
}

}  // namespace strata::mesh
