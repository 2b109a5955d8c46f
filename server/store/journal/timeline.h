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
  struct Interval {  // that contains an edit
    int number = 0;  // from 0
    std::int64_t edits = 0;
    std::int64_t first = 0, last = 0;  // sequences
    Time begun, ended;                 // of its first and last edit
    struct Share {
      std::string user;
      std::int64_t edits = 0;
    };
    std::vector<Share> people;    // kMaxNamed with the most edits, these first
    std::int64_t others = 0;      // further people
    std::vector<LayerId> layers;  // kMaxNamed with the most edits, these first
  };
  static constexpr int kMaxNamed = 3;
  std::int64_t edits = 0;  // in all intervals
  // begin of the first and end of the last interval; nothing: no edit
  std::optional<Time> from, to;
  std::vector<Interval> intervals;
};
struct TimelineQuery {
  std::vector<LayerId> layers;          // only edits of these
  std::optional<std::string> from, to;  // UTC; nothing: the first and the last edit
  int intervals = 1;
};

// A stroke, or another edit. A stroke whose batches lie on both sides of the page is cut there.
struct TimelineStep {
  std::int64_t first = 0, last = 0;  // sequences
  Uuid stroke;
  LayerId layer;
  std::string user, op;
  Timeline::Time time;       // of the last batch
  std::uint64_t texels = 0;  // sum over all batches
  double area_m2 = 0;
};
struct TimelineSteps {
  std::vector<TimelineStep> steps;  // ascending by their last sequence
  bool more = false;                // the journal continues in the direction of the query
};

}  // namespace strata::store
