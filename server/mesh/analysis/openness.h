#pragma once

#include <glm/glm.hpp>
#include <memory>

#include "core/progress.h"
#include "mesh/surface/geometry.h"

namespace strata::mesh {

// Ambient occlusion by ray tracing: the share of the surrounding light that reaches a point of a
// surface. It is 1 where nothing blocks the light, and 0 in a closed cavity. The rays of a point
// have cosine-weighted directions in its outer half-space. A ray is dark if it hits the surface,
// from either side, within `distance`. The directions are evenly distributed and rotated around the
// normal by an angle that depends on the position only. Neighboring points therefore differ by
// noise of about 0.4 / √rays, and every run gives the same result. Positions are in model space.
// Thread-safe.
class Openness {
 public:
  // Fails like RayScene::make.
  static Result<std::unique_ptr<Openness>> make(std::shared_ptr<const Geometry> geometry,
                                                float distance, int rays, Progress& progress);
  virtual ~Openness() = default;
  virtual float at(const glm::vec3& position, const glm::vec3& normal) const = 0;
};

}  // namespace strata::mesh
