#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace strata {

// Encodes all characters except letters, digits and -._~ as %XX (RFC 3986).
std::string percent_encode(std::string_view text);

// Returns nullopt for a text with an invalid escape or with a NUL.
std::optional<std::string> percent_decode(std::string_view text);

// Keeps invalid escapes. Use it for names in files that other programs wrote.
std::string percent_decode_leniently(std::string_view text);

}  // namespace strata
