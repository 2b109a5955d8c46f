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
  int max_refusals = 2000;  // refused minus accepted messages before the connection closes
  int views = room::kMaxViews;
  std::chrono::milliseconds presence_every{50};
  // With more users, presence updates are sent less often, so the load per session does not grow.
  int presence_people = 8;
};

}  // namespace strata::net
