#pragma once

#include <chrono>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "protocol/messages.h"

namespace strata::net {

// The events of other people's edits that one session has not sent yet. If hundreds of people watch
// a painter, one message for each edit and each person would take more processor time than the
// frames. So the events of one user in one layer that come within an interval become one event,
// with the newest sequence. Not thread-safe.
class EditEvents {
 public:
  using Clock = std::chrono::steady_clock;

  // Adds an event. Returns the time until the caller must call `take`, or nothing if an earlier
  // call of `add` has already returned such a time. The time is 0 if nothing was sent within the
  // last `interval`.
  std::optional<Clock::duration> add(const protocol::LayerEvent& event, Clock::duration interval,
                                     Clock::time_point now);
  // Returns the waiting events in the order of their sequences. An event is provisional if any of
  // its edits is.
  std::vector<protocol::LayerEvent> take(Clock::time_point now);
  // Like `take`, but before another message that must follow the waiting events. The time that
  // `add` has returned stays valid.
  std::vector<protocol::LayerEvent> take_before();

 private:
  // By layer and user.
  std::map<std::pair<std::int64_t, std::optional<std::string>>, protocol::LayerEvent> waiting_;
  bool is_due_ = false;  // the caller will call `take`
  std::optional<Clock::time_point> taken_;
};

}  // namespace strata::net
