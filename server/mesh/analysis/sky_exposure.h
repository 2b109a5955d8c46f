#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "core/error.h"
#include "mesh/surface/geometry.h"

namespace strata {
class Progress;
}

namespace strata::mesh {

// A part of the sky, and how long and how much light or rain comes from there.
struct SkySector {
  glm::dvec3 direction{0, 0, 1};  // towards the part of the sky, of length 1: east, north, up
  double hours = 0;
  double amount = 0;  // per area of a plane that faces the sector
};

// The light or rain that reaches points of a surface. A sector counts if the surface faces it and
// no triangle of the model is between. Positions are in model space. Thread-safe.
class SkyExposure {
 public:
  struct Sum {
    double hours = 0;
    double amount = 0;  // per area of the surface
  };

  // The directions of the sectors are in model axes. Fails like RayScene::make.
  static Result<std::unique_ptr<SkyExposure>> make(std::shared_ptr<const Geometry> geometry,
                                                   std::vector<SkySector> sectors,
                                                   Progress& progress);
  virtual ~SkyExposure() = default;
  // Returns NaN for a normal without a direction.
  virtual Sum at(const glm::vec3& position, const glm::vec3& normal) const = 0;
};

}  // namespace strata::mesh
