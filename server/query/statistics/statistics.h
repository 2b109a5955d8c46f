#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "mesh/texels/texel_graph.h"
#include "query/sampling/values.h"
#include "query/statistics/quantiles.h"
#include "query/statistics/tile_sums.h"

namespace strata::query {

struct KeyStatistics {
  std::uint64_t texels = 0;
  double area_m2 = 0;
  glm::dvec3 centroid{0};                   // world, weighted by area
  glm::dvec3 bounds_min{0}, bounds_max{0};  // world
  std::optional<std::uint64_t> pieces{};    // where asked for: connected areas of this key
  // where asked for: around these areas, along the surface
  std::optional<double> perimeter_m{};
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
  // 64 equal bins from min to max; one where all values are equal; empty where nothing is valid
  std::vector<Bin> histogram;
  // integer layers with ≤ 4096 distinct values; otherwise empty
  std::map<double, KeyStatistics> keys;
  std::optional<Quantiles> quantiles;  // where asked for and something has an area
  // where asked for: connected areas, of one value each in integer layers
  std::optional<std::uint64_t> pieces;
  std::optional<double> perimeter_m;  // where asked for: around what is valid, along the surface
};

struct StatisticsRequest {
  const TexelSelection* within = nullptr;  // null: the whole surface
  bool quantiles = false;
  bool pieces = false, perimeter = false;   // which need `graph`
  const mesh::TexelGraph* graph = nullptr;  // of the map
  TileSumsCache* cache = nullptr;           // of this layer; not used with `within`
  int threads = 1;
};

// The map must be of the layer's resolution.
Statistics statistics(const LayerView& view, const mesh::SurfaceMap& map, const glm::dvec3& origin,
                      double metres_per_unit, const StatisticsRequest& request = {});

}  // namespace strata::query
