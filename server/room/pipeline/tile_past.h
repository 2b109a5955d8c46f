#pragma once

#include <functional>

#include "domain/layers/history.h"
#include "domain/layers/layer.h"
#include "store/store.h"

namespace strata::room {

// Reads the history of a tile backward, and recomputes the texels of `current`, the tile after its
// newest revision. `turn` may change the state of a revision's edit before the revision is used.
// Ends when the resolver has an edit for every texel, or after all revisions. Blocks.
Result<TileResolver> resolve_tile(const TileData& current, const TileMask& texels,
                                  const Layer& layer, TileAddress tile, store::Store& store,
                                  const std::function<void(PastRevision&)>& turn);

}  // namespace strata::room
