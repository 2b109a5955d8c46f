#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "query/values.h"

namespace strata::query {

struct KeyStatistics {
  std::uint64_t texels = 0;
  double area_m2 = 0;
  glm::dvec3 centroid{0};                   // world, weighted by area
  glm::dvec3 bounds_min{0}, bounds_max{0};  // world
};

// Over valid surface texels (gutter excluded), weighted by true surface area.
struct Statistics {
  std::uint64_t texels = 0;
  double area_m2 = 0;
  double min = 0, max = 0, mean = 0, std = 0;
  struct Bin {
    double from = 0, to = 0;  // the last one includes `to`
    std::uint64_t texels = 0;
    double area_m2 = 0;
  };
  std::vector<Bin>
      histogram;  // 64 equal bins from min to max; one where all values are equal; empty where nothing is valid
  std::map<double, KeyStatistics> keys;  // integer layers with ≤ 4096 distinct values; otherwise empty
};

Statistics statistics(const LayerView& view, const mesh::SurfaceMap& map, const glm::dvec3& origin,
                      double metres_per_unit);

}  // namespace strata::query
