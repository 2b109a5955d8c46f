#pragma once

#include <string>
#include <string_view>

namespace strata {

// A text as people search for it: upper and lower case, accents and compatibility forms make no
// difference ("Depósito" → "deposito"; Unicode case folding and compatibility decomposition, by
// utf8proc). What is not UTF-8 stays as it is.
std::string search_text(std::string_view text);

}  // namespace strata
