#pragma once

#include <span>
#include <string>
#include <string_view>

#include "domain/tables/term.h"
#include "vocabulary/rdf.h"

namespace strata {

// The concepts of a SKOS vocabulary as terms. The code is the notation, otherwise the last part of
// the IRI; codes that are met twice get a number. `label` is the preferred label without a
// language, otherwise the English one, otherwise the first. Of several broader concepts the first
// by name is kept, and of several preferred labels of one language: the others are counted in
// `left_out`. invalid: it cannot be read, there is no concept in it, or one has more than `limits`
// take.
Result<TermList> read_terms_skos(std::string_view text, RdfSyntax syntax);

// A concept scheme of that name with the terms, in Turtle. Terms without a URI are written relative
// to the document. Colours and patterns are not of SKOS, and left out.
Result<std::string> terms_skos(const std::string& name, std::span<const Term> terms);

}  // namespace strata
