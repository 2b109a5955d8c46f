#pragma once

#include <memory>

#include "domain/people/role.h"
#include "room/room.h"

namespace strata::room {

// Returns the room as a user with this role sees it. No call returns hidden data: layers, values
// read from them, columns of records, frames and events. Returns the room itself if the role sees
// everything.
std::shared_ptr<Room> seen_as(std::shared_ptr<Room> room, Role role);

}  // namespace strata::room
