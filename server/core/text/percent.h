#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace strata {

// RFC 3986: all but letters, digits and -._~ becomes %XX.
std::string percent_encode(std::string_view text);

// Nothing for a text with an escape that is not one, or with a NUL.
std::optional<std::string> percent_decode(std::string_view text);

// Leaves as they are the escapes that are none: for names in files that others wrote.
std::string percent_decode_leniently(std::string_view text);

}  // namespace strata
