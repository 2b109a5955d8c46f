#include "mesh/analysis/openness.h"

#include <bit>
#include <cmath>
#include <numbers>
#include <vector>

#include "mesh/analysis/ray_scene.h"
#include "mesh/analysis/tangent_frame.h"

namespace strata::mesh {
namespace {

// Returns directions that are evenly distributed over the hemisphere with cosine-weighted density:
// a golden-angle spiral on the disc, projected up to the hemisphere (Malley's method).
std::vector<glm::vec3> cosine_directions(int count) {
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  std::vector<glm::vec3> directions(count);
  for (int i = 0; i < count; ++i) {
    const double squared = (i + 0.5) / count, radius = std::sqrt(squared), angle = golden * i;
    directions[i] =
        glm::vec3(radius * std::cos(angle), radius * std::sin(angle), std::sqrt(1 - squared));
  }
  return directions;
}

// Returns a number from 0 to 1 that depends on the position only.
float turn_of(const glm::vec3& p) {
  std::uint32_t h = 2166136261u;
  for (int k = 0; k < 3; ++k) h = (h ^ std::bit_cast<std::uint32_t>(p[k])) * 16777619u;
  h ^= h >> 15;
  h *= 2246822519u;
  h ^= h >> 13;
  return static_cast<float>(h >> 8) / 16777216.0f;
}

class RayOpenness final : public Openness {
 public:
  RayOpenness(std::unique_ptr<RayScene> scene, float distance, int rays)
      : scene_(std::move(scene)), distance_(distance), directions_(cosine_directions(rays)) {}

  float at(const glm::vec3& position, const glm::vec3& normal) const override {
    const float length = glm::length(normal);
    if (!(length > 0)) return std::nanf("");
    const TangentFrame frame(normal / length);
    const float turn = 2 * std::numbers::pi_v<float> * turn_of(position), c = std::cos(turn),
                s = std::sin(turn);
    const glm::vec3 along = c * glm::vec3(frame.x) + s * glm::vec3(frame.y),
                    across = c * glm::vec3(frame.y) - s * glm::vec3(frame.x), up(frame.z);
    int open = 0;
    for (const glm::vec3& d : directions_)
      if (!scene_->is_blocked(position, up, d.x * along + d.y * across + d.z * up, distance_))
        ++open;
    return static_cast<float>(open) / static_cast<float>(directions_.size());
  }

 private:
  std::unique_ptr<RayScene> scene_;
  float distance_;
  std::vector<glm::vec3> directions_;
};

}  // namespace

Result<std::unique_ptr<Openness>> Openness::make(std::shared_ptr<const Geometry> geometry,
                                                 float distance, int rays, Progress& progress) {
  auto scene = STRATA_TRY(RayScene::make(std::move(geometry), progress));
  return std::make_unique<RayOpenness>(std::move(scene), distance, rays);
}

}  // namespace strata::mesh
