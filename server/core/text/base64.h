#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace strata {

// RFC 4648. The first is padded; the second is for addresses: `-` and `_`, without padding.
std::string to_base64(std::span<const std::uint8_t> bytes);
std::string to_base64url(std::span<const std::uint8_t> bytes);

// Accepts both alphabets, with or without padding. Ignores extra bits at the end, as browsers do.
std::optional<std::vector<std::uint8_t>> from_base64(std::string_view text);

}  // namespace strata
