#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <memory>
#include <optional>

#include "core/progress.h"
#include "mesh/surface/geometry.h"

namespace strata::mesh {

// The triangles of a model, for ray tracing. Positions are in model space. Thread-safe.
class RayScene {
 public:
  // Fails with `out_of_memory` if the memory is too small for the ray tracer's tree, which takes
  // about 100 bytes per triangle. Also fails when cancelled.
  static Result<std::unique_ptr<RayScene>> make(std::shared_ptr<const Geometry> geometry,
                                                Progress& progress);
  ~RayScene();
  RayScene(const RayScene&) = delete;
  RayScene& operator=(const RayScene&) = delete;

  // Returns whether a ray from a point of a surface with this normal (length 1) hits a triangle,
  // from either side, within `distance`. The ray begins a little above the surface. `direction` has
  // length 1.
  bool is_blocked(const glm::vec3& position, const glm::vec3& normal, const glm::vec3& direction,
                  float distance = std::numeric_limits<float>::infinity()) const;

  // A point of the model's surface.
  struct Hit {
    std::uint32_t triangle = 0;
    glm::vec3 weights{0};  // of its corners
    float distance = 0;    // from the beginning of the ray
    bool from_behind = false;
  };
  // Returns the first hit of a ray farther than `least` from its beginning. `direction` has length
  // 1.
  std::optional<Hit> first_hit(const glm::vec3& from, const glm::vec3& direction,
                               float least) const;

 private:
  struct Tree;
  explicit RayScene(std::unique_ptr<Tree> tree);
  std::unique_ptr<Tree> tree_;
};

}  // namespace strata::mesh
