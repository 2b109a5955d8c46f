#pragma once

#include <chrono>
#include <cstddef>

#include "room/limits.h"

namespace strata::net {

// Of one live connection.
struct LiveLimits {
  std::size_t message_bytes = 256 * 1024;
  double messages_per_second = 500;
  double burst = 1000;
  int max_refusals = 2000;  // more refused for speed than taken, then the connection is closed
  int views = room::kMaxViews;
  std::chrono::milliseconds presence_every{50};
  // more make it rarer: to one session goes the same in a second, however many are there
  int presence_people = 8;
};

}  // namespace strata::net
