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
  glm::dvec3 centroid{0};                   // world coordinates, weighted by area
  glm::dvec3 bounds_min{0}, bounds_max{0};  // world
  std::optional<std::uint64_t> pieces{};    // if requested: number of connected areas of this key
  // if requested: the perimeter of these areas, along the surface
  std::optional<double> perimeter_m{};
};

// Statistics over valid surface texels without the gutter, weighted by true surface area.
struct Statistics {
  std::uint64_t texels = 0;
  double area_m2 = 0;
  double min = 0, max = 0, mean = 0, std = 0;
  // Of ratings, the mean is the linear damage index and this is the progressive one (Fitzner and
  // Heinrichs 2002).
  double root_mean_square = 0;
  struct Bin {
    double from = 0, to = 0;  // the last bin includes `to`
    std::uint64_t texels = 0;
    double area_m2 = 0;
  };
  // 64 bins of equal width from min to max; one bin if all values are equal; empty if no texel is
  // valid
  std::vector<Bin> histogram;
  // for integer layers with at most 4096 distinct values; otherwise empty
  std::map<double, KeyStatistics> keys;
  std::optional<Quantiles> quantiles;  // if requested, and if there is an area
  // if requested: number of connected areas; in integer layers, each area has one value
  std::optional<std::uint64_t> pieces;
  // if requested: the perimeter of all valid texels, along the surface
  std::optional<double> perimeter_m;
};

struct StatisticsRequest {
  const TexelSelection* within = nullptr;  // null means the whole surface
  bool quantiles = false;
  bool pieces = false, perimeter = false;   // both need `graph`
  const mesh::TexelGraph* graph = nullptr;  // the graph of the map
  TileSumsCache* cache = nullptr;           // the cache of this layer; not used with `within`
  int threads = 1;
};

// Computes the statistics of a layer. The map must have the resolution of the layer.
Statistics statistics(const LayerView& view, const mesh::SurfaceMap& map, const glm::dvec3& origin,
                      double metres_per_unit, const StatisticsRequest& request = {});

}  // namespace strata::query
