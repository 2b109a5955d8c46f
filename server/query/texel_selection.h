#pragma once

#include <cstdint>
#include <vector>

#include "mesh/surface_map.h"

namespace strata::query {

// Which texels of a surface map: a word for each of its slots, bit y * 8 + x, as in SurfaceMap::surface_mask.
using TexelSelection = std::vector<std::uint64_t>;

}  // namespace strata::query
