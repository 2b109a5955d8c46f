#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "core/progress.h"
#include "mesh/analysis/surface_samples.h"
#include "mesh/parallel.h"
#include "mesh/surface/geometry.h"

namespace strata::mesh {

// The parameters of M3C2, in units of the model that is measured.
struct ChangeScales {
  double normal = 0;        // diameter of the neighborhood whose mean normal is the direction
  double projection = 0;    // diameter of the cylinder
  double max_distance = 0;  // the farthest distance in either direction
  double registration = 0;  // standard error of the alignment of the two models
};

// The change of a surface since another survey of it: the multiscale model to model cloud
// comparison (M3C2) of Lague, Brodu and Leroux, "Accurate 3D comparison of complex topography with
// terrestrial laser scanner" (ISPRS Journal 82, 2013). A cylinder along the mean normal of this
// surface cuts both surfaces. The distance is the difference of the mean positions of both surfaces
// along the axis. Their scatter along the axis, σ, is the noise and the relief within the cylinder.
// The difference of two surfaces without change is within
//   1.96 · (√(σ₁²/n₁ + σ₂²/n₂) + registration)
// with a probability of 95 %. This is the level of detection. For few points, the first 1.96 is the
// corresponding quantile of Student's t distribution.
//
// The points of the method are the vertices of the mesh, weighted by their areas, and points within
// large triangles. n is the number of vertices, because points within a triangle do not vary
// independently. Vertices that are closer to each other than a tenth of the cylinder's diameter are
// averaged and count as one. The cylinder ignores surfaces that face the other way.
// Immutable after construction and thread-safe.
class ModelChange {
 public:
  // `metres_here` and `metres_there` are the lengths in meters of one unit of each model. The world
  // coordinates of both models use the same coordinate system. Requires half of each scale to be at
  // least SurfaceSamples::least_radius. Fails when cancelled. Reports progress as the first `share`
  // of the whole task.
  static Result<ModelChange> make(const Geometry& here, double metres_here, const Geometry& there,
                                  double metres_there, const ChangeScales& scales,
                                  Progress& progress, double share = 1,
                                  int threads = background_threads());

  struct Change {
    double distance;   // positive where this surface is in front of the other
    double detection;  // the level of detection at 95 %, positive
  };
  // `position` and `normal` are in the space of this model. Returns the change in units of this
  // model. Returns nothing if one of the surfaces has fewer than four points in the cylinder.
  std::optional<Change> at(const glm::vec3& position, const glm::vec3& normal) const;

 private:
  struct Side {
    SurfaceSamples samples;
    glm::dvec3 box_min, box_max;  // world
    glm::dvec3 origin;
    double units_per_here;  // units of this side in one unit of this model
  };
  // The mean position along the axis in units of this model, the variance of this mean, and the
  // number of independent points.
  struct Mean {
    double position, variance, count;
  };
  ModelChange(SurfaceSamples normals, Side here, Side there, const ChangeScales& scales);
  glm::vec3 mean_normal(const glm::vec3& position, const glm::vec3& normal) const;
  std::optional<Mean> mean_in_cylinder(const Side& side, const glm::dvec3& world,
                                       const glm::vec3& axis) const;

  SurfaceSamples normals_;
  Side here_, there_;
  ChangeScales scales_;
  double rounding_;  // the error of positions, which are floats
};

}  // namespace strata::mesh
