#pragma once

#include <set>

#include "domain/layers/layer.h"
#include "query/maps/key_names.h"
#include "room/room.h"

namespace strata::app {

// Returns the keys of a layer with a categorical legend, to which a map can add; nothing for other
// legends. `records`: keys that are in use although no texel has them.
Result<std::optional<query::KeyNames>> keys_of(room::Room& room, const Layer& layer,
                                               const std::set<double>& records);

// Adds a map's names to the layer's legend. Names are metadata, so only curators can add them:
// refuses (403) new names of other users, who can use existing names; ignores their new colors.
// Blocks.
Result<void> extend_legend(Role role, room::Room& room, const Layer& layer,
                           const query::KeyNames& keys);

}  // namespace strata::app
