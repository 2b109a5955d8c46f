#pragma once

#include <span>
#include <string>
#include <string_view>

#include "domain/tables/term.h"
#include "vocabulary/rdf.h"

namespace strata {

// Reads the concepts of a SKOS vocabulary as terms. The code of a term is its notation, or else the
// last part of its IRI. Repeated codes get a number. `label` is the preferred label without
// language, or else the English one, or else the first one. If a concept has several preferred
// labels in one language, the first in alphabetical order is kept. Of several broader concepts, the
// first that the text describes is kept, or else the first one. `left_out` counts the others.
// Returns the error `invalid` if the text is unreadable, has no concept, or exceeds the limits for
// terms.
Result<TermList> read_terms_skos(std::string_view text, RdfSyntax syntax);

// Writes the terms as a concept scheme called `name`, in Turtle. The IRI of a term without a URI
// is relative to the document. Leaves out colors and patterns, because SKOS does not have them.
Result<std::string> terms_skos(const std::string& name, std::span<const Term> terms);

}  // namespace strata
