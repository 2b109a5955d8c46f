#pragma once

#include <cstddef>
#include <string>

#include "core/error.h"
#include "domain/layers/layer.h"
#include "query/regions/surface_values.h"

namespace strata {
class Progress;
}
namespace strata::mesh {
struct TexelGraph;
}

namespace strata::query {

inline constexpr std::size_t kMaxBasins = 1'000'000;

// Divides the surface into the basins of a quantity, and returns the number of its basin at each
// texel with a value, as f32: 1 is the basin with the most area. `type` is the type of `values`.
//
// The surface is flooded from the lowest values on. Water of two basins that meets continues as one
// basin if one of the two is less than `height` (in the unit of the values) deep there. Otherwise
// they remain separate, and the meeting place is their border. So each basin is at least `height`
// deep, except the deepest one of a piece of surface. A texel belongs to the basin of its lowest
// neighbor. Between equal values, the border depends on the order of the texels in the atlas.
//
// The method is the watershed by flooding (Beucher and Lantuéjoul 1979) with the dynamics of minima
// (Grimaud 1992). Places where the values are not finite numbers are in no basin.
//
// Needs about 20 bytes of memory per texel of the map. Fails when cancelled, and with an `invalid`
// error at `field` for more than `max_basins` basins. `height` must not be negative.
Result<SurfaceValues> watershed_values(const SurfaceValues& values, ValueType type, double height,
                                       const mesh::SurfaceMap& map, const mesh::TexelGraph& graph,
                                       const std::string& field, Progress& progress,
                                       std::size_t max_basins = kMaxBasins);

}  // namespace strata::query
