#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>

namespace strata::room {

struct EditAnswer {
  std::int64_t sequence = 0;
  std::uint64_t texels_changed = 0;  // number of surface texels whose value or validity changed
  double area_m2 = 0;                // area of these texels
  bool repeated = false;             // the id was already used, so this request painted nothing
  bool provisional = false;          // the edit waits for review
};

nlohmann::json to_json(const EditAnswer& answer);

}  // namespace strata::room
