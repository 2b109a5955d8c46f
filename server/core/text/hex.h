#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace strata {

// Two lower-case digits for each byte.
std::string to_hex(std::span<const std::uint8_t> bytes);

// The value of a digit of either case; -1 for what is not one.
int hex_digit_value(char c);

}  // namespace strata
