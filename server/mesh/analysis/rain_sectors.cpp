#include "mesh/analysis/rain_sectors.h"

#include <cmath>
#include <numbers>
#include <numeric>

namespace strata::mesh {

std::vector<SkySector> rain_sectors(const RainClimate& climate) {
  constexpr double kMaxStep = 2 * std::numbers::pi / 60;
  const auto& shares = climate.wind_shares;
  const double all = std::accumulate(shares.begin(), shares.end(), 0.0);
  const double width = 2 * std::numbers::pi / static_cast<double>(shares.size());
  const int steps = static_cast<int>(std::ceil(width / kMaxStep));
  const double hours = climate.rain_mm / climate.rain_mm_per_hour;
  const double carried =
      2.0 / 9 * climate.wind_speed_m_s * std::pow(climate.rain_mm_per_hour, 8.0 / 9) * hours;
  std::vector<SkySector> result;
  for (std::size_t i = 0; i < shares.size(); ++i) {
    if (!(shares[i] > 0)) continue;
    const double part = shares[i] / all / steps;
    for (int step = 0; step < steps; ++step) {
      const double azimuth = width * (static_cast<double>(i) - 0.5 + (step + 0.5) / steps);
      const glm::dvec3 rain = part * glm::dvec3(carried * std::sin(azimuth),
                                                carried * std::cos(azimuth), climate.rain_mm);
      result.push_back({glm::normalize(rain), part * hours, glm::length(rain)});
    }
  }
  return result;
}

}  // namespace strata::mesh
