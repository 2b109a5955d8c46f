#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace strata {

// Returns the bytes of a text, which must live as long as the result.
inline std::span<const std::uint8_t> bytes_of(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

}  // namespace strata
