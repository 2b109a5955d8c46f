#pragma once

#include <vector>

#include "query/statistics/tile_sums.h"

namespace strata::mesh {
struct SurfaceMap;
}  // namespace strata::mesh

namespace strata::query {

// Whether areas of a layer are counted by value: for keys of records, and for classes of 8 bits.
// The values of other layers are measurements, of which there may be as many as texels.
bool tells_keys_apart(const Layer& layer);

// The keys of a tile's valid surface texels, ascending, without a limit. For a layer whose values
// are not counted separately there is one element, whose bits have no meaning. Empty if no texel is
// valid.
std::vector<TileSums::Key> surface_keys(const TileData& tile, TileAddress address,
                                        const Layer& layer, const mesh::SurfaceMap& map);

}  // namespace strata::query
