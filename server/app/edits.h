#pragma once

#include <atomic>
#include <cstdint>

#include "room/edit.h"
#include "room/room.h"

namespace strata::app {

// Counts the edits since the start of the server, for its metrics. All threads may increment the
// counters.
struct EditCounters {
  std::atomic<std::uint64_t> applied{0}, saved{0}, unsaved{0}, refused{0};
};

// Submits the edit to the room and waits until the edit is durable or refused. The edit belongs to
// the current Question, if any: if the question ends before the edit is painted, the edit is
// refused. Blocks.
Result<room::EditAnswer> edit_and_wait(room::Room& room, room::EditRequest edit,
                                       EditCounters& counters);

}  // namespace strata::app
