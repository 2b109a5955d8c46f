#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "query/sampling/values.h"
#include "query/statistics/quantiles.h"
#include "query/statistics/tile_sums.h"

namespace strata::mesh {
struct SurfaceMap;
struct TexelGraph;
}  // namespace strata::mesh

namespace strata::query {

struct KeyStatistics {
  std::uint64_t texels = 0;
  double area_m2 = 0;
  glm::dvec3 centroid{0};                   // world, weighted by area
  glm::dvec3 bounds_min{0}, bounds_max{0};  // world
  std::optional<std::uint64_t> pieces{};    // if requested: connected areas of this key
  // if requested: around these areas, along the surface
  std::optional<double> perimeter_m{};
};

// Over valid surface texels (gutter excluded), weighted by true surface area.
struct Statistics {
  std::uint64_t texels = 0;
  double area_m2 = 0;
  double min = 0, max = 0, mean = 0, std = 0;
  struct Bin {
    double from = 0, to = 0;  // the last bin includes `to`
    std::uint64_t texels = 0;
    double area_m2 = 0;
  };
  // 64 equal bins from min to max; one if all values are equal; empty if no texel is valid
  std::vector<Bin> histogram;
  // integer layers with ≤ 4096 distinct values; otherwise empty
  std::map<double, KeyStatistics> keys;
  std::optional<Quantiles> quantiles;  // if requested and an area exists
  // if requested: connected areas, of one value each in integer layers
  std::optional<std::uint64_t> pieces;
  std::optional<double> perimeter_m;  // if requested: around all valid texels, along the surface
};

struct StatisticsRequest {
  const TexelSelection* within = nullptr;  // null: the whole surface
  bool quantiles = false;
  bool pieces = false, perimeter = false;   // both need `graph`
  const mesh::TexelGraph* graph = nullptr;  // of the map
  TileSumsCache* cache = nullptr;           // of this layer; not used with `within`
  int threads = 1;
};

// The map must be of the layer's resolution.
Statistics statistics(const LayerView& view, const mesh::SurfaceMap& map, const glm::dvec3& origin,
                      double metres_per_unit, const StatisticsRequest& request = {});

}  // namespace strata::query
