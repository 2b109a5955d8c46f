#pragma once

#include <memory>

#include "domain/people/role.h"
#include "room/room.h"

namespace strata::room {

// The room as who has the role sees it. What they do not see is not there, through every door:
// layers and what reads them, columns of records, frames and events. The room itself, where they
// see all of it.
std::shared_ptr<Room> seen_as(std::shared_ptr<Room> room, Role role);

}  // namespace strata::room
