#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace strata {

// Names come from files and systems of any encoding; what is stored, and what goes into JSON, is
// UTF-8 (RFC 3629).

bool is_utf8(std::string_view text);

// Each byte that belongs to no character becomes U+FFFD.
std::string mended_utf8(std::string_view text);

// As many of its first bytes as are wanted, without a part of a character at their end.
std::string_view first_bytes(std::string_view text, std::size_t most);

}  // namespace strata
