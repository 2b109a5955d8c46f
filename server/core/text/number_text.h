#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "core/error.h"

namespace strata {

// Returns a number for people: at most six significant digits ("0.125", "1e-07").
std::string short_number(double value);

// Parses a whole number in decimal digits. Refused (invalid, at `field`): other text, out of range.
Result<std::int64_t> parse_integer(std::string_view text, std::int64_t low, std::int64_t high,
                                   const std::string& field);

}  // namespace strata
