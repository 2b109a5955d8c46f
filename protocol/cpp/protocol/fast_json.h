#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "protocol/list_limits.h"

namespace strata::protocol {

// Parses a text with simdjson, several times as fast as `parse_json`. Returns nothing for a text
// that `parse_json` refuses. Also returns nothing for the few texts that only simdjson refuses
// (integers beyond 64 bits, a byte order mark). The caller must then use `parse_json`, which also
// reports the error.
std::optional<nlohmann::json> read_json_fast(std::string_view text, int max_depth);

// A list that is too long.
struct ListTooLong {
  std::string path;    // "points", "layers[3].keys"
  std::string wanted;  // description of the expected content
};
// Finds the first list in a text that exceeds its limit, before the list is built. Does not read
// the rest of the text. Returns nothing if there is no such list, or if the text before it is not
// JSON.
std::optional<ListTooLong> find_long_list(std::string_view text, const ListLimits& lists);

}  // namespace strata::protocol
