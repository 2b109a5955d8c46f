#pragma once

#include <span>
#include <string>
#include <string_view>

#include "domain/tables/term.h"

namespace strata {

// CSV with the columns code, parent, label, label-es (or another language), definition, uri, color,
// pattern, in any order; only `code` must be there. Parents are named by their codes. An Error
// where the text is no CSV or its first row cannot be understood.
Result<TermList> read_terms_csv(std::string_view text);

// The same columns, those of all languages that a term has a label in. Begins with a byte order
// mark, as Excel wants it.
std::string terms_csv(std::span<const Term> terms, char separator);

}  // namespace strata
