#pragma once

#include <functional>

#include "domain/layers/history.h"
#include "domain/layers/layer.h"
#include "store/store.h"

namespace strata::room {

// Reads the history of a tile backward, until the resolver has an edit for every texel. `turn` may
// change the state of a revision's edit before the revision is used. Blocks.
Result<void> walk_back(TileResolver& resolver, const Layer& layer, TileAddress tile,
                       store::Store& store, const std::function<void(PastRevision&)>& turn);

}  // namespace strata::room
