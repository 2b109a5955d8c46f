#pragma once

#include <vector>

#include "query/statistics/tile_sums.h"

namespace strata::mesh {
struct SurfaceMap;
}  // namespace strata::mesh

namespace strata::query {

// Returns true if the areas of the layer are counted by value: for keys of records, and for classes
// of 8 bits. The values of other layers are measurements, and each texel may have a different one.
bool tells_keys_apart(const Layer& layer);

// Returns all keys of the valid surface texels of a tile, ascending. For a layer whose values are
// not counted separately, the result has one element, whose bits have no meaning. The result is
// empty if no texel is valid.
std::vector<TileSums::Key> surface_keys(const TileData& tile, TileAddress address,
                                        const Layer& layer, const mesh::SurfaceMap& map);

}  // namespace strata::query
