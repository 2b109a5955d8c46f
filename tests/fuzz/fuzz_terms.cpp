// Fuzzes term lists: SKOS as Turtle and as RDF/XML, and CSV. The first byte selects the format. The
// terms must be valid. Strata must be able to read a list that it has written, if a term list can
// store its URIs.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "core/text/utf8.h"
#include "domain/tables/column_value.h"
#include "vocabulary/terms_csv.h"
#include "vocabulary/terms_skos.h"

namespace {

using namespace strata;

void demand(bool holds) {
  if (!holds) std::abort();
}

bool can_be_stored(const Term& term) {
  Column column;
  column.kind = ColumnKind::url;
  return term.uri.empty() || check_value(column, term.uri, "uri").has_value();
}

void check(const Result<TermList>& list) {
  if (!list) {
    demand(!is_server_failure(list.error().code) && is_utf8(list.error().detail));
    return;
  }
  demand(list->terms.size() <= kMaxTerms && list->terms.size() <= list->rows);
  demand(list->mistakes.size() <= kMaxTermMistakes);
  for (const Term& term : list->terms) {
    demand(!term.code.empty() && term.code.size() <= kMaxCodeLength && is_utf8(term.code));
    Term checked = term;
    demand(check_term(checked).has_value() && checked.color == term.color);
  }
  if (list->terms.empty() || !std::ranges::all_of(list->terms, can_be_stored)) return;
  demand(read_terms_csv(terms_csv(list->terms, ';')).has_value());
  const auto turtle = terms_skos("Terms", list->terms);
  if (turtle) demand(read_terms_skos(*turtle, RdfSyntax::turtle).has_value());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view text(reinterpret_cast<const char*>(data + 1), size - 1);
  if (data[0] % 3 == 0)
    check(read_terms_skos(text, RdfSyntax::turtle));
  else if (data[0] % 3 == 1)
    check(read_terms_skos(text, RdfSyntax::rdf_xml));
  else
    check(read_terms_csv(text));
  return 0;
}
