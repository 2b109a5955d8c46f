#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "protocol/list_limits.h"

namespace strata::protocol {

// The value of a text that `parse_json` takes, read several times as fast by simdjson. Nothing for
// a text that it refuses, and for the few it takes that simdjson does not (whole numbers beyond 64
// bits, a byte order mark): who asks then reads it with care, which also says what is wrong.
std::optional<nlohmann::json> read_json_fast(std::string_view text, int max_depth);

// A list that is longer than it may be.
struct ListTooLong {
  std::string path;    // "points", "layers[3].keys"
  std::string wanted;  // what belongs there, in words
};
// The first of a text, found before anything of it is built, and without looking at what follows.
// Nothing where there is none, and where the text is no JSON up to there.
std::optional<ListTooLong> find_long_list(std::string_view text, const ListLimits& lists);

}  // namespace strata::protocol
