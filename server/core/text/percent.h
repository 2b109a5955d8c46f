#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace strata {

// RFC 3986: encodes all characters except letters, digits and -._~ as %XX.
std::string percent_encode(std::string_view text);

// Returns nothing for a text with an invalid escape or with a NUL.
std::optional<std::string> percent_decode(std::string_view text);

// Keeps invalid escapes: for names in files of other programs.
std::string percent_decode_leniently(std::string_view text);

}  // namespace strata
