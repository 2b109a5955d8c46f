#pragma once

#include <glm/glm.hpp>
#include <memory>

#include "core/progress.h"
#include "mesh/surface/geometry.h"

namespace strata::mesh {

// Ambient occlusion by rays: the share of the light from all around that reaches a point of a
// surface, 1 in the open, 0 in a closed cavity. Rays leave over the outer half-space with cosine
// weighting; a ray that meets the surface, from either side, within `distance` is dark. The
// directions are an even set, turned about the normal by an angle that depends on the position
// only: neighbors differ by noise of about 0.4 / √rays, and every run gives the same result. Model
// space. Thread-safe.
class Openness {
 public:
  // Refused (storage_full) where memory is too small for the ray tracer's tree, some 100 bytes a
  // triangle, and when cancelled.
  static Result<std::unique_ptr<Openness>> make(std::shared_ptr<const Geometry> geometry,
                                                float distance, int rays, Progress& progress);
  virtual ~Openness() = default;
  virtual float at(const glm::vec3& position, const glm::vec3& normal) const = 0;
};

}  // namespace strata::mesh
