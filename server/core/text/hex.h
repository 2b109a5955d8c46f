#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace strata {

// Writes two lowercase digits per byte.
std::string to_hex(std::span<const std::uint8_t> bytes);

// Returns the value of a digit in upper or lower case, and -1 for other characters.
int hex_digit_value(char c);

}  // namespace strata
