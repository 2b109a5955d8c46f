#pragma once

#include <vector>

#include "mesh/analysis/sky_exposure.h"

namespace strata::mesh {

// The wind while it rains, and the rain.
struct RainClimate {
  // How much of the rain falls with wind from each direction, clockwise from north. Only the
  // relations of these numbers count. At least one is greater than 0 and none is negative.
  std::vector<double> wind_shares;
  double wind_speed_m_s = 0;    // mean, while it rains
  double rain_mm = 0;           // the sum of the period
  double rain_mm_per_hour = 1;  // mean intensity while it rains, greater than 0
};

// Returns the directions from which rain falls, each with its hours and its amount in l/m². The
// rain of each wind direction is the sum of two vectors: the rain on the ground, which falls
// vertically, and the rain that the wind carries horizontally through a vertical plane. The second
// is the free-field formula of ISO 15927-3:2009 for the airfield index: per hour, 2/9 · wind speed
// in m/s · (rain in mm)^(8/9), in l/m². The amount on a free face is therefore the product of this
// vector and the normal. Each wind direction is spread evenly over its sector, in steps of at most
// 6°.
std::vector<SkySector> rain_sectors(const RainClimate& climate);

}  // namespace strata::mesh
