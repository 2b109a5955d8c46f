#pragma once

#include <chrono>
#include <cstddef>

#include "room/limits.h"

namespace strata::net {

// Limits of one live connection.
struct LiveLimits {
  std::size_t message_bytes = 256 * 1024;
  double messages_per_second = 500;
  double burst = 1000;
  int max_refusals = 2000;  // refused for speed minus accepted; more close the connection
  int views = room::kMaxViews;
  std::chrono::milliseconds presence_every{50};
  // with more people the updates are rarer: the rate per session stays the same
  int presence_people = 8;
};

}  // namespace strata::net
