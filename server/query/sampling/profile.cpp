#include "query/sampling/profile.h"

#include <algorithm>
#include <cmath>

#include "domain/scene/camera.h"
#include "mesh/rollout/rollout_rays.h"
#include "query/sampling/surface_point.h"

namespace strata::query {
namespace {

// Returns points on a line in steps of at most `step`, including the corners of the line.
template <class Point>
Result<std::vector<Point>> steps_of(std::span<const Point> corners, double step,
                                    const char* field) {
  const auto too_many = fail(ErrorCode::invalid, "Too many samples",
                             "A profile can have at most " + std::to_string(kMaxProfileSamples) +
                                 " samples. Choose longer steps or a shorter line.",
                             field);
  std::vector<Point> points{corners.front()};
  for (std::size_t i = 1; i < corners.size(); ++i) {
    const double steps = std::max(1.0, std::ceil(glm::length(corners[i] - corners[i - 1]) / step));
    if (!(steps + static_cast<double>(points.size()) <= static_cast<double>(kMaxProfileSamples)))
      return too_many;
    const int count = static_cast<int>(steps);
    for (int k = 1; k <= count; ++k)
      points.push_back(corners[i - 1] +
                       (corners[i] - corners[i - 1]) * (static_cast<double>(k) / count));
  }
  return points;
}

template <class Point, class Find>
Profile sample(const std::vector<Point>& points, Find find) {
  Profile profile;
  profile.samples.reserve(points.size());
  bool on_surface = false;
  glm::dvec3 last{0};
  for (const Point& at : points) {
    SurfacePoint point = find(at);
    if (point.hit && on_surface) profile.length += glm::distance(point.position, last);
    on_surface = point.hit;
    last = point.position;
    profile.samples.push_back({profile.length, std::move(point)});
  }
  return profile;
}

}  // namespace

Result<Profile> profile_near(const mesh::SearchTree& tree, const glm::dvec3& origin,
                             std::span<const glm::dvec3> places, double step,
                             const std::vector<LayerView>& layers) {
  const auto points = STRATA_TRY(steps_of(places, step, "step_mm"));
  return sample(points,
                [&](const glm::dvec3& at) { return nearest_point(tree, origin, at, layers); });
}

Result<Profile> profile_seen(const mesh::SearchTree& tree, const glm::dvec3& origin,
                             const Camera& camera, std::span<const glm::dvec2> path,
                             const std::vector<LayerView>& layers) {
  const auto points = STRATA_TRY(steps_of(path, 1.0, "path"));
  return sample(
      points, [&](const glm::dvec2& at) { return pick(tree, origin, camera, at.x, at.y, layers); });
}

Result<Profile> profile_unrolled(const mesh::RolloutRays& rays, const glm::dvec3& origin,
                                 std::span<const glm::dvec2> path, double step,
                                 const std::vector<LayerView>& layers) {
  const auto points = STRATA_TRY(steps_of(path, step, "step_mm"));
  return sample(points, [&](const glm::dvec2& at) {
    const auto found = rays.cast(at);
    return found ? surface_point(found->hit, origin, layers) : off_the_model(layers);
  });
}

}  // namespace strata::query
