#pragma once

#include <cstdint>
#include <map>

#include "query/sampling/values.h"
#include "query/statistics/tile_sums.h"

namespace strata::query {

struct KeyArea {
  std::uint64_t texels = 0;
  double area_m2 = 0;
  glm::dvec3 bounds_min{0}, bounds_max{0};  // world
};

// How much surface each key of a database layer has: as `statistics`, without a limit to how many
// keys there are. Valid surface texels, gutter excluded. Tiles that `cache` (of this layer) knows
// are not counted again.
std::map<std::int64_t, KeyArea> key_areas(const LayerView& view, const mesh::SurfaceMap& map,
                                          const glm::dvec3& origin, double metres_per_unit,
                                          TileSumsCache* cache = nullptr);

}  // namespace strata::query
