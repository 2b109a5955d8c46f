#pragma once

#include <string>
#include <string_view>

namespace strata {

// Normalizes a text for searches that ignore case, accents and compatibility forms ("Depósito" →
// "deposito"). Uses Unicode case folding and compatibility decomposition, from utf8proc. Does not
// change invalid UTF-8.
std::string search_text(std::string_view text);

// Returns the same text for texts that differ only in upper and lower case. Does not change invalid
// UTF-8.
std::string case_folded(std::string_view text);

}  // namespace strata
