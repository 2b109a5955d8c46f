#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace strata {

// Encode as in RFC 4648. The first function pads the text. The second one is for addresses: it uses
// `-` and `_`, and does not pad.
std::string to_base64(std::span<const std::uint8_t> bytes);
std::string to_base64url(std::span<const std::uint8_t> bytes);

// Accepts both alphabets, with or without padding. Ignores extra bits at the end, as browsers do.
std::optional<std::vector<std::uint8_t>> from_base64(std::string_view text);

}  // namespace strata
