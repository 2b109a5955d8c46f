#include "query/interpolation/readings.h"

#include <bit>
#include <cmath>

#include "core/progress.h"
#include "mesh/texels/texel_graph.h"

namespace strata::query {

Result<std::vector<Reading>> find_readings(const SurfaceValues& values, ValueType type,
                                           const mesh::SurfaceMap& map,
                                           const mesh::TexelGraph& graph, std::size_t max_readings,
                                           const Progress& progress) {
  std::vector<Reading> readings;
  std::vector<std::uint64_t> rest = values.valid;
  const auto take = [&](std::uint32_t texel) {
    const std::uint64_t bit = std::uint64_t{1} << texel % 64;
    const bool was_there = (rest[texel / 64] & bit) != 0;
    rest[texel / 64] &= ~bit;
    return was_there;
  };
  for (std::uint32_t slot = 0; slot < rest.size(); ++slot) {
    if (slot % 4096 == 0 && progress.cancelled()) return cancelled_problem();
    while (rest[slot] != 0) {
      const std::uint32_t first =
          slot * 64 + static_cast<std::uint32_t>(std::countr_zero(rest[slot]));
      Reading reading{decode_value(type, values.bits[first]), {first}};
      take(first);
      for (std::size_t next = 0; next < reading.texels.size(); ++next) {
        if (next % (1 << 20) == 0 && progress.cancelled()) return cancelled_problem();
        mesh::for_each_neighbour(map, graph, reading.texels[next], [&](std::uint32_t other) {
          if (values.bits[other] == values.bits[first] && take(other))
            reading.texels.push_back(other);
        });
      }
      if (!std::isfinite(reading.value)) continue;
      readings.push_back(std::move(reading));
      if (readings.size() > max_readings) return readings;
    }
  }
  return readings;
}

}  // namespace strata::query
