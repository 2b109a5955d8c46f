#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"

namespace strata {

enum class RdfSyntax { turtle, rdf_xml };  // Turtle includes N-Triples

// A triple of an RDF graph. Subjects and predicates are IRIs; blank nodes begin with "_:".
struct Triple {
  std::string subject, predicate;
  std::string object;
  bool is_literal = false;
  std::string language{};  // of a literal, in lowercase; may be empty
  std::string datatype{};  // the IRI of a literal's type; empty: a text. Not set by read_rdf.
};

// The base IRI for texts without a base. Relative IRIs in such a text are read as IRIs that begin
// with this base.
inline constexpr std::string_view kRelativeBase = "http://relative.invalid/";

// Returns whether a text is an absolute IRI (RFC 3987): a scheme, a colon, and no character that
// IRIs cannot contain.
bool is_iri(std::string_view text);

// Reads a graph with libraptor2, triple by triple, until `sink` returns false. Never fetches or
// includes addresses, files or external entities. The Error (invalid) contains the position of the
// first mistake. Only one call runs at a time in the process.
Result<void> read_rdf(std::string_view text, RdfSyntax syntax,
                      const std::function<bool(const Triple&)>& sink);

// Writes the triples as Turtle. IRIs that begin with kRelativeBase are written relative to the
// document, without a base.
struct RdfPrefix {
  std::string name, iri;
};
Result<std::string> write_turtle(std::span<const Triple> triples,
                                 std::span<const RdfPrefix> prefixes);

}  // namespace strata
