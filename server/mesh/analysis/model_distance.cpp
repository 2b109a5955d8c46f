#include "mesh/analysis/model_distance.h"

#include <algorithm>
#include <limits>

namespace strata::mesh {

ModelDistance::ModelDistance(const glm::dvec3& origin_here, double metres_here,
                             std::shared_ptr<const Geometry> there, double metres_there,
                             double max_distance)
    : there_(there),
      tree_(there),
      normals_(there),
      origin_here_(origin_here),
      there_per_here_(metres_here / metres_there),
      max_distance_(max_distance) {}

float ModelDistance::at(const glm::vec3& position) const {
  const glm::dvec3 world_there = (origin_here_ + glm::dvec3(position)) * there_per_here_;
  const glm::vec3 point(world_there - there_->origin);
  const auto hit = tree_.nearest(point, static_cast<float>(max_distance_ * there_per_here_));
  if (!hit) return std::numeric_limits<float>::quiet_NaN();
  // Inside a face, the normal of the face determines the sign. On an edge or a vertex, the mean of
  // the surrounding normals determines the sign.
  constexpr float kOnEdge = 1e-5f;
  const glm::vec3& w = hit->barycentric;
  glm::vec3 normal = hit->normal;
  if (std::min({w.x, w.y, w.z}) < kOnEdge) {
    normal = glm::vec3(0);
    for (int k = 0; k < 3; ++k)
      normal +=
          w[k] *
          normals_.at_position(
              there_->vertices[there_->indices[3 * std::size_t{hit->triangle} + k]].position_index);
  }
  const float sign = glm::dot(point - hit->position, normal) < 0 ? -1.0f : 1.0f;
  return sign * hit->distance / static_cast<float>(there_per_here_);
}

}  // namespace strata::mesh
