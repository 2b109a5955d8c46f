#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "core/error.h"

namespace strata {

// A number for people: six significant digits, no more than it has ("0.125", "1e-07").
std::string short_number(double value);

// A whole number in decimal digits. Refused (invalid, at `field`): other text, out of range.
Result<std::int64_t> parse_integer(std::string_view text, std::int64_t low, std::int64_t high,
                                   const std::string& field);

}  // namespace strata
