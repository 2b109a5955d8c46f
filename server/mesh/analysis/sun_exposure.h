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

// A part of the sky, and how long and how strongly the sun shines from there during a period.
struct SunSector {
  glm::dvec3 direction{0, 0, 1};  // towards the sun, of length 1: east, north, up
  double hours = 0;
  double energy = 0;  // on a plane that faces the sun, in kWh/m²
};

// Days of a year of 365 days; 0 is 1 January. A period can continue into the next year.
struct SunPeriod {
  int first = 0;
  int days = 365;
};

// Returns the sectors of about 5° through which the sun passes above the horizon, summed over the
// days of the period. `latitude` is in degrees, positive in the north. Declination and distance of
// the sun are the series of Spencer (1971). The energy is that of the direct light under a clear
// sky at sea level: Meinel and Meinel (1976), with the air mass of Kasten and Young (1989). There
// is no diffuse light, no refraction and no weather.
std::vector<SunSector> sun_sectors(double latitude, const SunPeriod& period);

// The sunlight that reaches points of a surface. A sector counts if the surface faces it and no
// triangle of the model is between. Because each sector has one direction, the borders of shadows
// are exact to about 2.5° of the sun's path. Positions are in model space. Thread-safe.
class SunExposure {
 public:
  struct Sum {
    double hours = 0;   // of direct sun
    double energy = 0;  // on the surface, in kWh/m²
  };

  // The directions of the sectors are in model axes. Fails like RayScene::make.
  static Result<std::unique_ptr<SunExposure>> make(std::shared_ptr<const Geometry> geometry,
                                                   std::vector<SunSector> sectors,
                                                   Progress& progress);
  virtual ~SunExposure() = default;
  // Returns NaN for a normal without a direction.
  virtual Sum at(const glm::vec3& position, const glm::vec3& normal) const = 0;
};

}  // namespace strata::mesh
