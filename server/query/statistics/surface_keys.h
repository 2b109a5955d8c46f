#pragma once

#include <vector>

#include "query/statistics/tile_sums.h"

namespace strata::query {

// Whether areas of a layer are kept by value: keys of records, and the classes that 8 bits hold.
// The values of others are measurements, of which there may be as many as texels.
bool tells_keys_apart(const Layer& layer);

// What the valid surface texels of a tile hold, key by key, ascending, however many there are; of a
// layer whose values are not told apart one element, whose bits mean nothing. Nothing where nothing
// is valid.
std::vector<TileSums::Key> surface_keys(const TileData& tile, TileAddress address,
                                        const Layer& layer, const mesh::SurfaceMap& map);

}  // namespace strata::query
