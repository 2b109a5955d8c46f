#pragma once

#include <set>

#include "domain/layers/layer.h"
#include "query/maps/key_names.h"
#include "room/room.h"

namespace strata::app {

// Returns the keys in a categorical legend, to which a map can add keys. Returns nothing for other
// legends. `records` contains keys that are in use although no texel has them.
Result<std::optional<query::KeyNames>> keys_of(room::Room& room, const Layer& layer,
                                               const std::set<double>& records);

// Adds names from a map to the layer's legend. Names are metadata, so only curators can add them.
// Refuses (403) new names from other users, and ignores their new colors. Other users can use
// existing names. Blocks.
Result<void> extend_legend(Role role, room::Room& room, const Layer& layer,
                           const query::KeyNames& keys);

}  // namespace strata::app
