#pragma once

#include <atomic>
#include <cstdint>

#include "room/edit.h"
#include "room/room.h"

namespace strata::app {

// Counts edits since the server's start, for its metrics. Any thread may add.
struct EditCounters {
  std::atomic<std::uint64_t> applied{0}, saved{0}, unsaved{0}, refused{0};
};

// Submits the edit to the room and waits until it is durable or refused. Blocks.
Result<room::EditAnswer> edit_and_wait(room::Room& room, room::EditRequest edit,
                                       EditCounters& counters);

}  // namespace strata::app
