#pragma once

#include <memory>
#include <string>

#include "room/room.h"

namespace strata::room {

// The room as who has the role sees it. What they do not see is not there, through every door:
// layers and what reads them, columns of records, frames and events. The room itself, where they
// see all of it.
std::shared_ptr<Room> seen_as(std::shared_ptr<Room> room, Role role);

// The answer for a layer that is not there, and for one that somebody does not see.
tl::unexpected<Error> no_such_layer(const std::string& ref);

}  // namespace strata::room
