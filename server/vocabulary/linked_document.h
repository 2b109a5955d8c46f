#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>

#include "core/error.h"
#include "vocabulary/rdf.h"

// Documents in JSON-LD 1.1 and their form in Turtle. JSON-LD names classes and properties by short
// terms, and a context gives their IRIs. The contexts of standards are published documents, which
// programs know. The server never fetches them: a LinkedContext lists the terms that it uses.
namespace strata {

// How JSON-LD reads the value of a term. Each of the properties may have a list of values.
enum class LinkedKind {
  type,   // a class; no property
  node,   // an IRI or an object with members
  list,   // the same, with a kept order
  word,   // a term of the kind `type`: "commenting"
  text,   // a text, a number or a boolean, or {"@value": …, "@language": …}
  time,   // a text of the type xsd:dateTime
  count,  // a number of the type xsd:nonNegativeInteger
};

struct LinkedTerm {
  std::string_view name, iri;  // iri: whole or with a prefix, "crm:E53_Place"
  LinkedKind kind = LinkedKind::node;
  // Absent in the published context. The document defines it.
  bool is_own = false;
};

struct LinkedContext {
  std::string_view published;  // address of the published context; may be empty
  std::span<const LinkedTerm> terms;
  std::span<const RdfPrefix> prefixes;
};

// Returns the value of `@context`.
nlohmann::json context_of(const LinkedContext& context);

// Returns the triples of a document as JSON-LD reads them. Objects without an `id` become blank
// nodes. Throws std::logic_error for a member that the context does not define.
std::vector<Triple> triples_of(const nlohmann::json& document, const LinkedContext& context);

Result<std::string> linked_turtle(const nlohmann::json& document, const LinkedContext& context);

}  // namespace strata
