#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "core/error.h"

namespace strata {

// Formats a number for display, with at most six significant digits ("0.125", "1e-07").
std::string short_number(double value);

// Parses a whole number in decimal digits. Returns an `invalid` error at `field` for other text and
// for a number out of range.
Result<std::int64_t> parse_integer(std::string_view text, std::int64_t low, std::int64_t high,
                                   const std::string& field);

}  // namespace strata
