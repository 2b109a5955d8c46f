#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string_view>

#include "core/error.h"
#include "protocol/list_limits.h"

namespace strata::protocol {

struct JsonLimits {
  std::size_t max_bytes = 256 * 1024;
  int max_depth = 32;                 // of nested objects and arrays
  const ListLimits* lists = nullptr;  // null: the length of lists is not limited
};

// Parses JSON text from outside the server. Accepts only valid UTF-8 without duplicate members,
// without NUL in texts, with numbers in the range of double, and with nothing after the value.
// Returns `too_large` if the text is too long, `malformed` if it is not JSON, else `invalid`.
// Refuses a list beyond its limit before its items are built, and does not read the rest.
Result<nlohmann::json> parse_json(std::string_view text, const JsonLimits& limits = {});

}  // namespace strata::protocol
