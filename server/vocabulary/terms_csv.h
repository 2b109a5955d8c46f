#pragma once

#include <span>
#include <string>
#include <string_view>

#include "domain/tables/term.h"

namespace strata {

// Reads CSV with the columns code, parent, label, label-es (or another language), definition, uri,
// color, pattern, in any order. Only `code` is required. A parent is given by its code. Returns an
// error if the text is not CSV or its first row is invalid.
Result<TermList> read_terms_csv(std::string_view text);

// Writes the same columns, with labels in all languages. The text begins with a byte order mark,
// which Excel needs.
std::string terms_csv(std::span<const Term> terms, char separator);

}  // namespace strata
