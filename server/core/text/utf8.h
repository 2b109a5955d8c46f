#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace strata {

// Names come from files and systems with any encoding. Stored text and JSON are UTF-8 (RFC 3629).

bool is_utf8(std::string_view text);

// Replaces each byte that is not part of a valid character by U+FFFD.
std::string mended_utf8(std::string_view text);

// Returns the number of characters (code points), as PostgreSQL's char_length does.
std::size_t character_count(std::string_view text);

// Returns the first bytes of the text, at most `most`, without a partial character at the end.
std::string_view first_bytes(std::string_view text, std::size_t most);

}  // namespace strata
