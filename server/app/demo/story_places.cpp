#include "app/demo/story_places.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace strata::app {
namespace {

constexpr int kDegrees = 360;
constexpr double kWall_mm = 2.2;  // thinner than the wall of the pot

int degree_of(double angle) {
  const int degree = static_cast<int>(std::floor(angle)) % kDegrees;
  return degree < 0 ? degree + kDegrees : degree;
}

}  // namespace

StoryPlaces::StoryPlaces(const mesh::Geometry& geometry) : origin_(geometry.origin) {
  axis_ = glm::dvec2(geometry.box_min + geometry.box_max) / 2.0;
  bottom_ = geometry.box_min.z;
  height_ = std::max(1e-3, double(geometry.box_max.z) - bottom_);
  const int rows = static_cast<int>(std::ceil(height_)) + 1;
  outer_.assign(std::size_t(rows) * kDegrees, 0.f);
  for (const mesh::Vertex& vertex : geometry.vertices) {
    const glm::dvec2 from_axis = glm::dvec2(vertex.position) - axis_;
    const int degree = degree_of(std::atan2(from_axis.y, from_axis.x) * 180 / std::numbers::pi);
    const int row = static_cast<int>(vertex.position.z - bottom_);
    float& outer = outer_[std::size_t(std::clamp(row, 0, rows - 1)) * kDegrees + degree];
    outer = std::max(outer, static_cast<float>(glm::length(from_axis)));
  }
}

double StoryPlaces::outer_radius(double angle, double z) const {
  const int rows = static_cast<int>(outer_.size() / kDegrees);
  const int row = std::clamp(static_cast<int>(z - bottom_), 0, rows - 1);
  // Searches neighboring cells because a coarse mesh has cells without vertices.
  for (int reach = 1; reach < 12; ++reach) {
    float outer = 0;
    for (int dz = -reach; dz <= reach; ++dz)
      for (int da = -reach; da <= reach; ++da)
        outer = std::max(outer, outer_[std::size_t(std::clamp(row + dz, 0, rows - 1)) * kDegrees +
                                       degree_of(angle + da)]);
    if (outer > 0) return outer;
  }
  return 0;
}

glm::dvec3 StoryPlaces::outward(const Place& at) const {
  const double angle = at.angle * std::numbers::pi / 180;
  return {std::cos(angle), std::sin(angle), 0};
}

glm::dvec3 StoryPlaces::place(const Place& at) const {
  const double z = bottom_ + at.height * height_;
  const glm::dvec3 from_axis = outward(at) * outer_radius(at.angle, z);
  return glm::dvec3(axis_, z) + from_axis + origin_;
}

std::vector<glm::dvec3> StoryPlaces::line(const std::vector<Place>& path) const {
  std::vector<glm::dvec3> points;
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    const int steps =
        std::max(1, static_cast<int>(std::ceil(glm::distance(place(path[i]), place(path[i + 1])))));
    for (int step = i == 0 ? 0 : 1; step <= steps; ++step) {
      const double t = double(step) / steps;
      points.push_back(place({std::lerp(path[i].angle, path[i + 1].angle, t),
                              std::lerp(path[i].height, path[i + 1].height, t)}));
    }
  }
  return points;
}

bool StoryPlaces::is_outside(const glm::dvec3& point) const {
  const glm::dvec2 from_axis = glm::dvec2(point) - axis_;
  const double angle = std::atan2(from_axis.y, from_axis.x) * 180 / std::numbers::pi;
  return glm::length(from_axis) >= outer_radius(angle, point.z) - kWall_mm;
}

}  // namespace strata::app
