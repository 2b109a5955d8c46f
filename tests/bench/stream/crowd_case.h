#pragma once

#include <nlohmann/json.hpp>

#include "bench/stream/link.h"

namespace strata::bench {

// Actions of the active viewers of a case; `turn_and_paint`: every other one paints.
enum class Hands { rest, turn, turn_step_by_step, paint, turn_and_paint };
const char* name(Hands hands);

struct CrowdCase {
  LinkQuality link;  // of each viewer
  int active = 1, idle = 0;
  Hands hands = Hands::turn;
  bool is_same_view = false;  // of idle viewers; otherwise each has a different camera
  // one more viewer, which turns the camera and reads nothing after its first picture
  bool has_stalled = false;

  nlohmann::json json() const;
  bool paints(int number) const;  // `number`: of an active viewer
};

}  // namespace strata::bench
