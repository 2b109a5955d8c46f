#include "query/values.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/texel_lookup.h"

namespace strata::query {
namespace {

SurfacePoint surface_point(const mesh::SearchTree::Hit& hit, const glm::dvec3& origin,
                           const std::vector<LayerView>& layers) {
  SurfacePoint point{true, glm::dvec3(hit.position) + origin, hit.normal, hit.distance, hit.uv, {}};
  point.values.reserve(layers.size());
  for (const auto& layer : layers) point.values.push_back(value_at(layer, hit.uv));
  return point;
}

SurfacePoint off_the_model(const std::vector<LayerView>& layers) {
  SurfacePoint point;
  for (const auto& layer : layers) point.values.push_back({layer.layer.slug, false, 0});
  return point;
}

bool is_finite(const glm::vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

}  // namespace

LayerValue value_at(const LayerView& view, glm::vec2 uv) {
  const auto bits = bits_at(view.snapshot.tiles, view.layer.resolution, uv);
  if (!bits) return {view.layer.slug, false, 0};
  return {view.layer.slug, true, decode_value(view.layer.type, *bits)};
}

SurfacePoint nearest_point(const mesh::SearchTree& tree, const glm::dvec3& origin, const glm::dvec3& world_point,
                           const std::vector<LayerView>& layers) {
  const glm::vec3 in_model(world_point - origin);
  if (!is_finite(in_model)) return off_the_model(layers);
  const auto hit = tree.nearest(in_model, std::numeric_limits<float>::max());
  return hit ? surface_point(*hit, origin, layers) : off_the_model(layers);
}

SurfacePoint pick(const mesh::SearchTree& tree, const glm::dvec3& origin, const Camera& camera, double x, double y,
                  const std::vector<LayerView>& layers) {
  if (!(x >= 0 && y >= 0 && x <= camera.width && y <= camera.height)) return off_the_model(layers);
  const Ray ray = ray_through_pixel(camera, x, y);
  const RaySpan kept = kept_span(camera, ray);
  if (kept.begin > kept.end) return off_the_model(layers);
  const glm::vec3 start(ray.origin + kept.begin * ray.direction - origin), direction(ray.direction);
  if (!is_finite(start) || !is_finite(direction)) return off_the_model(layers);
  auto hit = tree.first_hit(start, direction);
  if (!hit || kept.begin + hit->distance > kept.end) return off_the_model(layers);
  if (eye_is_cut_away(camera) && glm::dot(hit->normal, direction) > 0)
    return off_the_model(layers);  // a solid's inside
  hit->distance += static_cast<float>(kept.begin);
  return surface_point(*hit, origin, layers);
}

}  // namespace strata::query
