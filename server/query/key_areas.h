#pragma once

#include <cstdint>
#include <map>

#include "query/values.h"

namespace strata::query {

struct KeyArea {
  std::uint64_t texels = 0;
  double area_m2 = 0;
};

// How much surface each key of a database layer has: as `statistics`, without a limit to how many keys there are. Valid surface
// texels, gutter excluded.
std::map<std::int64_t, KeyArea> key_areas(const LayerView& view, const mesh::SurfaceMap& map, double metres_per_unit);

}  // namespace strata::query
