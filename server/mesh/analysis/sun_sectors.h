#pragma once

#include <vector>

#include "mesh/analysis/sky_exposure.h"

namespace strata::mesh {

// Days of a year of 365 days; 0 is 1 January. A period can continue into the next year.
struct SunPeriod {
  int first = 0;
  int days = 365;
};

// Returns the sectors of about 5° through which the sun passes above the horizon, summed over the
// days of the period, with amounts in kWh/m². `latitude` is in degrees, positive in the north.
// Declination and distance of the sun are the series of Spencer (1971). The energy is that of the
// direct light under a clear sky at sea level: Meinel and Meinel (1976), with the air mass of
// Kasten and Young (1989). There is no diffuse light, no refraction and no weather. Because each
// sector has one direction, the borders of shadows are exact to about 2.5° of the sun's path.
std::vector<SkySector> sun_sectors(double latitude, const SunPeriod& period);

}  // namespace strata::mesh
