#pragma once

#include <glm/glm.hpp>
#include <memory>

#include "mesh/surface/search_tree.h"
#include "mesh/surface/surface_normals.h"

namespace strata::mesh {

// The signed distance from points of one model to the surface of another. It is positive in front
// of the surface and negative behind it. The sign comes from the pseudo-normal at the nearest point
// (see SurfaceNormals), so the other surface need not be closed. Thread-safe.
class ModelDistance {
 public:
  // `metres_here` and `metres_there` are the lengths in meters of one unit of each model. The world
  // coordinates of both models use the same coordinate system.
  ModelDistance(const glm::dvec3& origin_here, double metres_here,
                std::shared_ptr<const Geometry> there, double metres_there, double max_distance);

  // `position` is in the space of this model. Returns the distance in units of this model, or NaN
  // if the other surface is farther away than `max_distance`.
  float at(const glm::vec3& position) const;

 private:
  std::shared_ptr<const Geometry> there_;
  SearchTree tree_;
  SurfaceNormals normals_;
  glm::dvec3 origin_here_;
  double there_per_here_, max_distance_;
};

}  // namespace strata::mesh
