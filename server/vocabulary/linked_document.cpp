#include "vocabulary/linked_document.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <stdexcept>

namespace strata {
namespace {

constexpr std::string_view kRdf = "http://www.w3.org/1999/02/22-rdf-syntax-ns#",
                           kXsd = "http://www.w3.org/2001/XMLSchema#";

const LinkedTerm& term_called(const LinkedContext& context, std::string_view name) {
  const auto found = std::ranges::find(context.terms, name, &LinkedTerm::name);
  if (found == context.terms.end())
    throw std::logic_error("no term of linked data: " + std::string(name));
  return *found;
}

std::string whole_iri(const LinkedContext& context, std::string_view iri) {
  for (const RdfPrefix& prefix : context.prefixes)
    if (iri.size() > prefix.name.size() && iri.starts_with(prefix.name) &&
        iri[prefix.name.size()] == ':')
      return prefix.iri + std::string(iri.substr(prefix.name.size() + 1));
  return std::string(iri);
}

// JSON-LD reads 12.0 as the integer 12. Other numbers have an exponent, because Turtle reads 12.5
// as a decimal number and 1.25e1 as a double.
std::string number_text(double value) {
  char text[40];
  const bool is_whole = std::trunc(value) == value && std::abs(value) < 1e15;
  const char* const end =
      is_whole ? std::to_chars(text, text + sizeof text, static_cast<std::int64_t>(value)).ptr
               : std::to_chars(text, text + sizeof text, value, std::chars_format::scientific).ptr;
  return {text, static_cast<std::size_t>(end - text)};
}

// Returns the prefixes of the IRIs in the triples.
std::vector<RdfPrefix> used_prefixes(std::span<const Triple> triples,
                                     std::span<const RdfPrefix> prefixes) {
  std::vector<RdfPrefix> used;
  for (const RdfPrefix& prefix : prefixes)
    if (std::ranges::any_of(triples, [&](const Triple& triple) {
          return triple.predicate.starts_with(prefix.iri) ||
                 triple.datatype.starts_with(prefix.iri) ||
                 (!triple.is_literal && triple.object.starts_with(prefix.iri));
        }))
      used.push_back(prefix);
  return used;
}

class Reader {
 public:
  explicit Reader(const LinkedContext& context) : context_(context) {}

  // Returns the name of the node.
  std::string read(const nlohmann::json& node) {
    if (node.is_string()) return whole_iri(context_, node.get<std::string>());
    std::string name =
        node.contains("id") ? node.at("id").get<std::string>() : "_:b" + std::to_string(++blanks_);
    for (const auto& [member, value] : node.items()) {
      if (member == "id" || member == "@context") continue;
      if (member == "type")
        each(value, [&](const nlohmann::json& type) {
          put(name, std::string(kRdf) + "type", iri_of(type.get<std::string>()));
        });
      else
        read_property(name, term_called(context_, member), value);
    }
    return name;
  }

  std::vector<Triple> take() { return std::move(triples_); }

 private:
  static void each(const nlohmann::json& value, const auto& visit) {
    if (!value.is_array()) return visit(value);
    for (const nlohmann::json& one : value) visit(one);
  }

  std::string iri_of(std::string_view name) const {
    return whole_iri(context_, term_called(context_, name).iri);
  }

  void put(const std::string& subject, std::string predicate, std::string object) {
    triples_.push_back({subject, std::move(predicate), std::move(object)});
  }

  void read_property(const std::string& subject, const LinkedTerm& term,
                     const nlohmann::json& value) {
    const std::string predicate = whole_iri(context_, term.iri);
    if (term.kind == LinkedKind::list) return put(subject, predicate, read_list(value));
    each(value, [&](const nlohmann::json& one) {
      if (term.kind == LinkedKind::node)
        put(subject, predicate, read(one));
      else if (term.kind == LinkedKind::word)
        put(subject, predicate, iri_of(one.get<std::string>()));
      else
        put_literal(subject, predicate, one, term.kind);
    });
  }

  std::string read_list(const nlohmann::json& values) {
    const std::string nil = std::string(kRdf) + "nil";
    std::string first = nil, last;
    for (const nlohmann::json& value : values) {
      const std::string place = "_:b" + std::to_string(++blanks_);
      if (last.empty())
        first = place;
      else
        put(last, std::string(kRdf) + "rest", place);
      put(place, std::string(kRdf) + "first", read(value));
      last = place;
    }
    if (!last.empty()) put(last, std::string(kRdf) + "rest", nil);
    return first;
  }

  void put_literal(const std::string& subject, const std::string& predicate,
                   const nlohmann::json& value, LinkedKind kind) {
    Triple triple{subject, predicate, {}, true};
    if (kind == LinkedKind::count) {
      triple.object = value.dump();
      triple.datatype = std::string(kXsd) + "nonNegativeInteger";
    } else if (value.is_object()) {
      triple.object = value.at("@value").get<std::string>();
      triple.language = value.at("@language").get<std::string>();
    } else if (value.is_string()) {
      triple.object = value.get<std::string>();
      if (kind == LinkedKind::time) triple.datatype = std::string(kXsd) + "dateTime";
    } else {
      triple.object = value.is_number_float() ? number_text(value.get<double>()) : value.dump();
      triple.datatype =
          std::string(kXsd) + (value.is_boolean()                             ? "boolean"
                               : triple.object.find('e') == std::string::npos ? "integer"
                                                                              : "double");
    }
    triples_.push_back(std::move(triple));
  }

  const LinkedContext& context_;
  std::vector<Triple> triples_;
  int blanks_ = 0;
};

}  // namespace

nlohmann::json context_of(const LinkedContext& context) {
  nlohmann::json own = nlohmann::json::object();
  for (const LinkedTerm& term : context.terms) {
    if (!term.is_own) continue;
    nlohmann::json& entry = own[std::string(term.name)];
    const std::string iri = whole_iri(context, term.iri);
    switch (term.kind) {
      case LinkedKind::type:
      case LinkedKind::text: entry = iri; break;
      case LinkedKind::node: entry = {{"@id", iri}, {"@type", "@id"}}; break;
      case LinkedKind::list:
        entry = {{"@id", iri}, {"@type", "@id"}, {"@container", "@list"}};
        break;
      case LinkedKind::word: entry = {{"@id", iri}, {"@type", "@vocab"}}; break;
      case LinkedKind::count:
        entry = {{"@id", iri}, {"@type", std::string(kXsd) + "nonNegativeInteger"}};
        break;
      case LinkedKind::time:
        entry = {{"@id", iri}, {"@type", std::string(kXsd) + "dateTime"}};
        break;
    }
  }
  if (context.published.empty()) {
    own["id"] = "@id";
    own["type"] = "@type";
    return own;
  }
  if (own.empty()) return context.published;
  return {context.published, std::move(own)};
}

std::vector<Triple> triples_of(const nlohmann::json& document, const LinkedContext& context) {
  Reader reader(context);
  reader.read(document);
  return reader.take();
}

Result<std::string> linked_turtle(const nlohmann::json& document, const LinkedContext& context) {
  const auto triples = triples_of(document, context);
  return write_turtle(triples, used_prefixes(triples, context.prefixes));
}

}  // namespace strata
