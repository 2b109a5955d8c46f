#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "mesh/analysis/surface_samples.h"

namespace strata::mesh {

// The curvatures of a surface at a point, in 1/unit. They are positive where the surface bulges
// outward and negative where it is hollow.
struct Curvature {
  double max = 0, min = 0;  // principal curvatures, max ≥ min
  double mean() const { return (max + min) / 2; }
  double gaussian() const { return max * min; }  // 1/unit²
};

// Fits a quadric to the samples within the radius, weighted by area and nearness. The quadric is a
// height over the plane perpendicular to their mean normal. Noise and details finer than the radius
// are averaged out. Returns nothing where the neighborhood does not determine a quadric: fewer than
// eight samples, or all samples on a line.
std::optional<Curvature> curvature_at(const SurfaceSamples& samples, const glm::vec3& point,
                                      const glm::vec3& normal);

// Returns the distance (≥ 0) from `point` to the best-fitting plane of the samples within the
// radius (least squares, weighted by area). Returns nothing where they do not determine a plane:
// fewer than three samples, or all samples on a line.
std::optional<double> roughness_at(const SurfaceSamples& samples, const glm::vec3& point,
                                   const glm::vec3& normal);

}  // namespace strata::mesh
