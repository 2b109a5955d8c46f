#pragma once

#include <nlohmann/json.hpp>

#include "bench/stream/link.h"

namespace strata::bench {

// Actions of the active viewers of a case. With `turn_and_paint`, every other viewer paints.
enum class Hands { rest, turn, turn_step_by_step, paint, turn_and_paint };
const char* name(Hands hands);

struct CrowdCase {
  LinkQuality link;  // the link of each viewer
  int active = 1, idle = 0;
  Hands hands = Hands::turn;
  bool is_same_view = false;  // idle viewers share one camera; otherwise each has its own
  // Adds a viewer that turns its camera and reads nothing after its first frame.
  bool has_stalled = false;

  nlohmann::json json() const;
  bool paints(int number) const;  // `number`: the number of an active viewer
};

}  // namespace strata::bench
