#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "protocol/list_limits.h"

namespace strata::protocol {

// Returns the value of a text that `parse_json` accepts, read several times as fast by simdjson.
// Returns nothing for a text that `parse_json` refuses, and for the few that it accepts but
// simdjson does not (whole numbers beyond 64 bits, a byte order mark): the caller then uses the
// strict reader, which also reports the error.
std::optional<nlohmann::json> read_json_fast(std::string_view text, int max_depth);

// A list that exceeds its limit.
struct ListTooLong {
  std::string path;    // "points", "layers[3].keys"
  std::string wanted;  // the expected content, in words
};
// Finds the first such list of a text before any of it is built, without reading the rest. Returns
// nothing if there is no such list, or if the text is not JSON up to there.
std::optional<ListTooLong> find_long_list(std::string_view text, const ListLimits& lists);

}  // namespace strata::protocol
