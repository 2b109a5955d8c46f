#include "bench/stream/crowd_case.h"

namespace strata::bench {

const char* name(Hands hands) {
  switch (hands) {
    case Hands::rest: return "rest";
    case Hands::turn: return "turn";
    case Hands::turn_step_by_step: return "turn step by step";
    case Hands::paint: return "paint";
    case Hands::turn_and_paint: return "turn and paint";
  }
  return "";
}

nlohmann::json CrowdCase::json() const {
  nlohmann::json json{{"link", link.name},
                      {"active", active},
                      {"idle", idle},
                      {"hands", name(hands)},
                      {"stalled", has_stalled}};
  if (idle > 0) json["idle_views"] = is_same_view ? "same" : "own";
  return json;
}

bool CrowdCase::paints(int number) const {
  return hands == Hands::paint || (hands == Hands::turn_and_paint && number % 2 == 1);
}

}  // namespace strata::bench
