#pragma once

#include <string>
#include <string_view>

namespace strata {

// Normalizes a text for searches, without regard to case, accents and compatibility forms
// ("Depósito" → "deposito"; Unicode case folding and compatibility decomposition, by utf8proc).
// Invalid UTF-8 stays unchanged.
std::string search_text(std::string_view text);

}  // namespace strata
