#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"

namespace strata {

enum class RdfSyntax { turtle, rdf_xml };  // Turtle has N-Triples in it

// A triple of an RDF graph. Subjects and predicates are IRIs; blank nodes begin with "_:".
struct Triple {
  std::string subject, predicate;
  std::string object;
  bool is_literal = false;
  std::string language;  // of a literal, in lower case; empty: none
};

// What IRIs of a text without a base of its own are relative to: they begin with it.
inline constexpr std::string_view kRelativeBase = "http://relative.invalid/";

// Reads a graph by libraptor2, triple by triple, until the sink says false. Nothing is ever fetched
// or included: neither addresses nor files nor external entities. An Error (invalid) says where the
// text stops being what it should be. One at a time in the process.
Result<void> read_rdf(std::string_view text, RdfSyntax syntax,
                      const std::function<bool(const Triple&)>& sink);

// The triples as Turtle. IRIs that begin with kRelativeBase are written relative to the document,
// without naming a base.
struct RdfPrefix {
  std::string name, iri;
};
Result<std::string> write_turtle(std::span<const Triple> triples,
                                 std::span<const RdfPrefix> prefixes);

}  // namespace strata
