#include "mesh/surface/surface_normals.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace strata::mesh {
namespace {

const float kCosCrease = std::cos(glm::radians(40.0f));

std::array<glm::dvec3, 3> corners(const Geometry& geometry, std::size_t triangle) {
  std::array<glm::dvec3, 3> points;
  for (std::size_t k = 0; k < 3; ++k)
    points[k] =
        geometry.positions[geometry.vertices[geometry.indices[3 * triangle + k]].position_index];
  return points;
}

glm::dvec3 unit_or_zero(const glm::dvec3& v) {
  const double length = glm::length(v);
  return length > 0 ? v / length : glm::dvec3(0);
}

}  // namespace

SurfaceNormals::SurfaceNormals(std::shared_ptr<const Geometry> geometry)
    : geometry_(std::move(geometry)) {
  std::vector<glm::dvec3> sums(geometry_->positions.size(), glm::dvec3(0));
  for (std::size_t t = 0; t < geometry_->triangle_count(); ++t) {
    const auto p = corners(*geometry_, t);
    const glm::dvec3 normal = unit_or_zero(glm::cross(p[1] - p[0], p[2] - p[0]));
    for (std::size_t k = 0; k < 3; ++k) {
      const glm::dvec3 a = unit_or_zero(p[(k + 1) % 3] - p[k]),
                       b = unit_or_zero(p[(k + 2) % 3] - p[k]);
      const double angle = std::acos(std::clamp(glm::dot(a, b), -1.0, 1.0));
      sums[geometry_->vertices[geometry_->indices[3 * t + k]].position_index] += angle * normal;
    }
  }
  of_position_.resize(sums.size());
  std::transform(sums.begin(), sums.end(), of_position_.begin(),
                 [](const glm::dvec3& sum) { return glm::vec3(unit_or_zero(sum)); });
}

glm::vec3 SurfaceNormals::of_face(std::uint32_t triangle) const {
  const auto p = corners(*geometry_, triangle);
  return glm::vec3(unit_or_zero(glm::cross(p[1] - p[0], p[2] - p[0])));
}

glm::vec3 SurfaceNormals::at_corner(std::uint32_t triangle, int k) const {
  const glm::vec3 smooth =
      of_position_[geometry_->vertices[geometry_->indices[3 * std::size_t{triangle} + k]]
                       .position_index];
  const glm::vec3 face = of_face(triangle);
  return glm::dot(face, face) > 0 && glm::dot(smooth, face) < kCosCrease ? face : smooth;
}

glm::vec3 SurfaceNormals::at(std::uint32_t triangle, const glm::vec3& weights) const {
  const glm::vec3 face = of_face(triangle);
  const bool has_face = glm::dot(face, face) > 0;
  glm::vec3 sum(0);
  for (int k = 0; k < 3; ++k) {
    const glm::vec3 smooth =
        of_position_[geometry_->vertices[geometry_->indices[3 * std::size_t{triangle} + k]]
                         .position_index];
    sum += weights[k] * (has_face && glm::dot(smooth, face) < kCosCrease ? face : smooth);
  }
  const float length = glm::length(sum);
  return length > 0 ? sum / length : face;
}

}  // namespace strata::mesh
