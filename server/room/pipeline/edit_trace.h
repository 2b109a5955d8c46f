#pragma once

#include <chrono>
#include <string_view>

#include "core/error.h"
#include "core/ids.h"
#include "core/trace.h"
#include "room/edit_timings.h"

namespace strata::room {

// The trace of one edit, and the times when its stages began. The time of a stage
// that has not begun is zero.
struct EditTrace {
  using Clock = std::chrono::steady_clock;

  TraceId id;
  Clock::time_point arrived = Clock::now();
  Clock::time_point started{};    // after the queue and the search in the journal
  Clock::time_point computed{};   // only for edits that a worker computes
  Clock::time_point painted{};    // the texels are in the mirror
  Clock::time_point submitted{};  // to the journal
  double paint_ms = 0;            // the part of the time on the GPU thread, without the wait for it
};

struct TracedEdit {
  ModelId model_id = 0;
  LayerId layer_id = 0;
  std::string_view op;
  bool is_stroke = false;
};

// Counts the stages of an edit that has ended, and writes one line with their times if the edit
// took at least `slow_after` (0: no such limit), if the server caused its failure, or if the level
// of the module `room` is debug. `why` is null if the edit was saved.
void report_edit(const EditTrace& trace, const TracedEdit& edit, const Error* why,
                 EditTimings& timings, std::chrono::milliseconds slow_after);

}  // namespace strata::room
