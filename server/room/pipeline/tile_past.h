#pragma once

#include <functional>

#include "domain/layers/history.h"
#include "domain/layers/layer.h"
#include "store/store.h"

namespace strata::room {

// Walks back through a tile's history, but only until every texel of the resolver has its author.
// `turn` may change the state of an edit before it is used. Blocks.
Result<void> walk_back(TileResolver& resolver, const Layer& layer, TileAddress tile,
                       store::Store& store, const std::function<void(PastRevision&)>& turn);

}  // namespace strata::room
