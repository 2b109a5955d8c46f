#pragma once

#include <set>

#include "domain/layers/layer.h"
#include "query/maps/key_names.h"
#include "room/room.h"

namespace strata::app {

// The keys of a layer whose legend is categorical, for a map to add to; nothing where it has
// another legend. `records`: keys that are not free though nothing of them is painted.
Result<std::optional<query::KeyNames>> keys_of(room::Room& room, const Layer& layer,
                                               const std::set<double>& records);

// Writes what a map added into the layer's legend. Names are metadata, so only a curator adds them:
// refused (403) for others, who may use those that are there; new colours of theirs are left out.
// Blocks.
Result<void> extend_legend(Role role, room::Room& room, const Layer& layer,
                           const query::KeyNames& keys);

}  // namespace strata::app
