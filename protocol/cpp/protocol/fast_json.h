#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "protocol/list_limits.h"

namespace strata::protocol {

// A list that is longer than it may be.
struct ListTooLong {
  std::string path;  // "points", "layers[3].keys"
  std::string wanted;
};

// The value of a text that `parse_json` takes, read several times as fast by simdjson. Nothing for a text that it refuses, and for the few it
// takes that simdjson does not (whole numbers beyond 64 bits, a byte order mark): who asks then reads it with care, which also says what is wrong.
// `too_long`: what broke `lists`, which is looked at before items are built; nothing is returned then.
std::optional<nlohmann::json> read_json_fast(std::string_view text, int max_depth, const ListLimits* lists = nullptr,
                                             std::optional<ListTooLong>* too_long = nullptr);

}  // namespace strata::protocol
