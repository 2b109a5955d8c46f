#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "mesh/analysis/surface_samples.h"

namespace strata::mesh {

// Curvatures of a surface at a point, in 1/unit: positive where it bulges outward, negative where
// it is hollow.
struct Curvature {
  double max = 0, min = 0;  // principal, max ≥ min
  double mean() const { return (max + min) / 2; }
  double gaussian() const { return max * min; }  // 1/unit²
};

// Fits a quadric to the samples within the radius (weighted by area and nearness), as a height over
// the plane across their mean normal. Noise and details finer than the radius are averaged out.
// Returns nothing where the neighborhood does not determine a quadric: fewer than eight samples, or
// all in a line.
std::optional<Curvature> curvature_at(const SurfaceSamples& samples, const glm::vec3& point,
                                      const glm::vec3& normal);

// Distance (≥ 0) from `point` to the plane that fits the samples within the radius best (least
// squares, weighted by area). Returns nothing where they do not determine a plane: fewer than three
// samples, or all in a line.
std::optional<double> roughness_at(const SurfaceSamples& samples, const glm::vec3& point,
                                   const glm::vec3& normal);

}  // namespace strata::mesh
