#include "mesh/analysis/sun_sectors.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace strata::mesh {
namespace {

constexpr int kDaysPerYear = 365;
constexpr int kStepsPerDay = 360;  // one degree of the hour angle, or four minutes
constexpr double kSectorDegrees = 5;
constexpr double kSolarConstant = 1.361;  // kW/m², outside the atmosphere at the mean distance

struct SunOfDay {
  double declination;  // radians
  double strength;     // relative to the mean distance of the sun
};

SunOfDay sun_of(int day) {
  const double b = 2 * std::numbers::pi * day / kDaysPerYear;
  return {0.006918 - 0.399912 * std::cos(b) + 0.070257 * std::sin(b) - 0.006758 * std::cos(2 * b) +
              0.000907 * std::sin(2 * b) - 0.002697 * std::cos(3 * b) + 0.00148 * std::sin(3 * b),
          1.00011 + 0.034221 * std::cos(b) + 0.00128 * std::sin(b) + 0.000719 * std::cos(2 * b) +
              0.000077 * std::sin(2 * b)};
}

// Returns the direct light of a clear sky, in kW/m².
double direct_light(double sine_of_height, double strength) {
  const double height = glm::degrees(std::asin(std::min(1.0, sine_of_height)));
  const double air_mass = 1 / (sine_of_height + 0.50572 * std::pow(height + 6.07995, -1.6364));
  return kSolarConstant * strength * std::pow(0.7, std::pow(air_mass, 0.678));
}

}  // namespace

std::vector<SkySector> sun_sectors(double latitude, const SunPeriod& period) {
  const double sine = std::sin(glm::radians(latitude)), cosine = std::cos(glm::radians(latitude));
  constexpr double kHoursPerStep = 24.0 / kStepsPerDay;
  // The directions in a sector are added up with their energies, so the energy on a plane that
  // faces the whole sector is exact.
  struct Sums {
    glm::dvec3 energy{0};
    double hours = 0;
  };
  std::map<std::pair<int, int>, Sums> sectors;
  for (int day = period.first; day < period.first + period.days; ++day) {
    const SunOfDay sun = sun_of(day % kDaysPerYear);
    const double up_part = sine * std::sin(sun.declination),
                 north_part = cosine * std::sin(sun.declination), along = std::cos(sun.declination);
    for (int step = 0; step < kStepsPerDay; ++step) {
      const double hour_angle = 2 * std::numbers::pi * (step + 0.5) / kStepsPerDay;  // from noon
      const glm::dvec3 direction(-along * std::sin(hour_angle),
                                 north_part - sine * along * std::cos(hour_angle),
                                 up_part + cosine * along * std::cos(hour_angle));
      if (direction.z <= 0) continue;
      const double height = glm::degrees(std::asin(std::min(1.0, direction.z)));
      const double azimuth = glm::degrees(std::atan2(direction.x, direction.y));
      const auto row = static_cast<int>(height / kSectorDegrees);
      // Sectors near the zenith are narrower in azimuth, so they have a similar size in the sky.
      const double width =
          kSectorDegrees / std::cos(glm::radians(std::min(88.0, (row + 0.5) * kSectorDegrees)));
      Sums& sums = sectors[{row, static_cast<int>(std::floor(azimuth / width))}];
      sums.energy += direct_light(direction.z, sun.strength) * kHoursPerStep * direction;
      sums.hours += kHoursPerStep;
    }
  }
  std::vector<SkySector> result;
  result.reserve(sectors.size());
  for (const auto& [place, sums] : sectors)
    result.push_back({glm::normalize(sums.energy), sums.hours, glm::length(sums.energy)});
  return result;
}

}  // namespace strata::mesh
