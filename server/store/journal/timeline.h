#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/ids.h"
#include "core/uuid.h"

namespace strata::store {

// The edits of a model over time, counted in equal intervals.
struct Timeline {
  using Time = std::chrono::system_clock::time_point;
  struct Interval {  // an interval that contains an edit
    int number = 0;  // counted from 0
    std::int64_t edits = 0;
    // Sequences. If the journal no longer has the state at the last edit, `last` is the last state
    // before it that the journal has, which can be 0.
    std::int64_t first = 0, last = 0;
    Time begun, ended;  // times of the first and the last edit
    struct Share {
      std::string user;
      std::int64_t edits = 0;
    };
    std::vector<Share> people;    // the kMaxNamed users with the most edits, in descending order
    std::int64_t others = 0;      // number of other users
    std::vector<LayerId> layers;  // the kMaxNamed layers with the most edits, in descending order
  };
  static constexpr int kMaxNamed = 3;
  std::int64_t edits = 0;  // number of edits in all intervals
  // beginning of the first and end of the last interval; nothing if there is no edit
  std::optional<Time> from, to;
  std::vector<Interval> intervals;
};
struct TimelineQuery {
  std::vector<LayerId> layers;          // only edits of these layers
  std::optional<std::string> from, to;  // UTC; nothing means the first or the last edit
  int intervals = 1;
};

// A stroke, or another edit. A stroke with batches on two pages is divided between them.
struct TimelineStep {
  // Sequences. If the journal no longer has the state at the last batch, `last` and `time` are
  // those of the next state that it has. Several steps can lead to it.
  std::int64_t first = 0, last = 0;
  Uuid stroke;
  LayerId layer;
  std::string user, op;
  Timeline::Time time;       // time of the last batch
  std::uint64_t texels = 0;  // sum over all batches
  double area_m2 = 0;
};
struct TimelineSteps {
  std::vector<TimelineStep> steps;  // ascending by `last`
  bool more = false;                // the journal has more steps in the direction of the query
};

}  // namespace strata::store
