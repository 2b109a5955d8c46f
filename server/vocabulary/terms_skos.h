#pragma once

#include <span>
#include <string>
#include <string_view>

#include "domain/tables/term.h"
#include "vocabulary/rdf.h"

namespace strata {

// Reads the concepts of a SKOS vocabulary as terms. The code is the notation, otherwise the last
// part of the IRI; repeated codes get a number. `label` is the preferred label without a language,
// otherwise the English one, otherwise the first. Keeps the first by name of several broader
// concepts, and of several preferred labels of one language; `left_out` counts the others. invalid:
// the text is unreadable, has no concept, or exceeds the limits of terms.
Result<TermList> read_terms_skos(std::string_view text, RdfSyntax syntax);

// Writes a concept scheme of that name with the terms, in Turtle. Terms without a URI are relative
// to the document. Leaves out colors and patterns, which SKOS does not have.
Result<std::string> terms_skos(const std::string& name, std::span<const Term> terms);

}  // namespace strata
