#include "mesh/rollout/rollout_rays.h"

#include <algorithm>
#include <cmath>

namespace strata::mesh {
namespace {

// The positions of texels and the rays are stored as floats. Surface that is closer together than
// this share of a ray's length counts as one surface.
constexpr double kRounding = 1e-5;

}  // namespace

RolloutRays::RolloutRays(const SearchTree& tree, const Geometry& geometry,
                         const RolloutSheet& sheet)
    : tree_(tree), origin_(geometry.origin), sheet_(sheet) {
  // The rays from the outside begin beyond the corners of the model's box.
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 place(corner & 1 ? geometry.box_max.x : geometry.box_min.x,
                           corner & 2 ? geometry.box_max.y : geometry.box_min.y,
                           corner & 4 ? geometry.box_max.z : geometry.box_min.z);
    reach_ = std::max(reach_, glm::distance(origin_ + place, sheet.surface.point));
  }
}

RolloutRays::Ray RolloutRays::ray_at(const RolloutSheet::SurfacePlace& place) const {
  const DevelopedSurface& surface = sheet_.surface;
  const bool is_outside = sheet_.side == RolloutSide::outside;
  const glm::dvec3 outward = surface.ray(place.angle);
  const double to_axis = surface.to_axis(place.angle, place.slant);
  const glm::dvec3 on_axis = surface.at(place.angle, place.slant) - to_axis * outward - origin_;
  // A point of the box is at most this far from each point of the axis in its extent.
  const double length = 2 * reach_ + to_axis;
  return {is_outside ? on_axis + length * outward : on_axis, is_outside ? -outward : outward,
          length};
}

std::optional<RolloutHit> RolloutRays::cast(const glm::dvec2& on_sheet) const {
  const auto place = sheet_.on_surface(on_sheet);
  if (!place) return std::nullopt;
  const Ray ray = ray_at(*place);
  const auto hit = tree_.first_hit(glm::vec3(ray.start), glm::vec3(ray.direction));
  if (!hit || hit->distance > ray.length || glm::dot(glm::dvec3(hit->normal), ray.direction) >= 0)
    return std::nullopt;
  return RolloutHit{*place, *hit};
}

bool RolloutRays::sees(const glm::vec3& position, const RolloutSheet::SurfacePlace& place) const {
  const Ray ray = ray_at(place);
  const double distance = glm::dot(glm::dvec3(position) - ray.start, ray.direction);
  const double rounding = kRounding * ray.length;
  auto hit = tree_.first_hit(glm::vec3(ray.start), glm::vec3(ray.direction));
  if (hit && hit->distance < distance - rounding) return false;
  // At an edge of the mesh, the ray can miss the point's own triangle.
  if (!hit || hit->distance > distance + rounding)
    hit = tree_.nearest(position, static_cast<float>(rounding));
  return hit && glm::dot(glm::dvec3(hit->normal), ray.direction) < 0;
}

}  // namespace strata::mesh
