#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string_view>

#include "core/error.h"
#include "protocol/list_limits.h"

namespace strata::protocol {

struct JsonLimits {
  std::size_t max_bytes = 256 * 1024;
  int max_depth = 32;                 // nested objects and arrays
  const ListLimits* lists = nullptr;  // null: lists have any length
};

// Parses external JSON text strictly: valid UTF-8, no duplicate member, no NUL in a text, no number
// beyond double, nothing after the value. Problems: 413 if it is too long, 400 if it is not JSON,
// 422 for the rest. A list beyond its limit is refused before its items are built, without reading
// the rest.
Result<nlohmann::json> parse_json(std::string_view text, const JsonLimits& limits = {});

}  // namespace strata::protocol
