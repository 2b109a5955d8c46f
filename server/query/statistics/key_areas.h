#pragma once

#include <cstdint>
#include <map>

#include "query/sampling/values.h"
#include "query/statistics/tile_sums.h"

namespace strata::mesh {
struct SurfaceMap;
}  // namespace strata::mesh

namespace strata::query {

struct KeyArea {
  std::uint64_t texels = 0;
  double area_m2 = 0;
  glm::dvec3 bounds_min{0}, bounds_max{0};  // world
};

// Returns the surface area of each key of a layer of records, as in `statistics` but without a
// limit on the number of keys. Includes only valid surface texels, not the gutter. Tiles in
// `cache`, which is a cache of this layer, are not summed again.
std::map<std::int64_t, KeyArea> key_areas(const LayerView& view, const mesh::SurfaceMap& map,
                                          const glm::dvec3& origin, double metres_per_unit,
                                          TileSumsCache* cache = nullptr);

}  // namespace strata::query
