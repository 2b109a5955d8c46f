#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>

namespace strata::room {

struct EditAnswer {
  std::int64_t sequence = 0;
  std::uint64_t texels_changed = 0;  // surface texels whose value or validity changed
  double area_m2 = 0;                // their surface
  bool repeated = false;             // the id was known: this request painted nothing
  bool provisional = false;          // the edit waits for review
};

nlohmann::json to_json(const EditAnswer& answer);

}  // namespace strata::room
