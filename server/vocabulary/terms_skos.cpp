#include "vocabulary/terms_skos.h"

#include <algorithm>
#include <map>

#include "core/text/ascii.h"
#include "core/text/utf8.h"

namespace strata {
namespace {

const std::string kSkos = "http://www.w3.org/2004/02/skos/core#";
const std::string kType = "http://www.w3.org/1999/02/22-rdf-syntax-ns#type";
constexpr std::size_t kMaxConceptBytes = 256u << 20;  // of all data that is kept from a text

using ByLanguage = std::map<std::string, std::set<std::string>>;
struct Concept {
  bool is_described = false;  // the text has a description of it, not only its name
  bool is_other = false;      // a scheme or a collection of concepts
  std::set<std::string> notations, broader;
  ByLanguage labels, definitions, notes;
};

// Returns the text without a language. If there is no such text, returns the English one, or else
// the first one.
std::string plainest(const ByLanguage& by_language) {
  for (const char* tag : {"", "en", "en-gb", "en-us"})
    if (const auto found = by_language.find(tag); found != by_language.end())
      return *found->second.begin();
  return by_language.empty() ? std::string() : *by_language.begin()->second.begin();
}

// The concepts of a text, by IRI.
class Concepts {
 public:
  // Returns false if there are too many concepts.
  bool take(const Triple& triple) {
    const std::string& predicate = triple.predicate;
    if (predicate == kType) {
      if (triple.object == kSkos + "Concept") of(triple.subject).is_described = true;
      for (const char* other : {"ConceptScheme", "Collection", "OrderedCollection"})
        if (triple.object == kSkos + other) of(triple.subject).is_other = true;
    } else if (predicate.starts_with(kSkos)) {
      const std::string_view name = std::string_view(predicate).substr(kSkos.size());
      triple.is_literal ? take_text(triple, name) : take_relation(triple, name);
    }
    return concepts_.size() <= 2 * kMaxTerms && bytes_ <= kMaxConceptBytes;
  }

  std::map<std::string, Concept>& all() { return concepts_; }

 private:
  Concept& of(const std::string& iri) {
    const auto [found, is_new] = concepts_.try_emplace(iri);
    if (is_new) bytes_ += sizeof(Concept) + iri.size();
    return found->second;
  }

  void take_text(const Triple& triple, std::string_view name) {
    const std::string text(trimmed(triple.object));
    if (text.empty()) return;
    if (name == "notation") {
      add(of(triple.subject).notations, text);
      return;
    }
    const auto part = name == "prefLabel"    ? &Concept::labels
                      : name == "definition" ? &Concept::definitions
                      : name == "scopeNote"  ? &Concept::notes
                                             : nullptr;
    if (!part) return;
    Concept& subject = of(triple.subject);
    subject.is_described = subject.is_described || name == "prefLabel";
    add((subject.*part)[triple.language], text);
  }

  void take_relation(const Triple& triple, std::string_view name) {
    if (name == "broader" || name == "broaderGeneric" || name == "broaderPartitive") {
      Concept& subject = of(triple.subject);
      subject.is_described = true;
      add(subject.broader, triple.object);
    } else if (name == "narrower") {
      of(triple.subject).is_described = true;
      add(of(triple.object).broader, triple.subject);
    }
  }

  void add(std::set<std::string>& texts, const std::string& text) {
    if (texts.insert(text).second) bytes_ += text.size() + 64;
  }

  std::map<std::string, Concept> concepts_;
  std::size_t bytes_ = 0;
};

std::string code_of(const std::string& iri, const Concept& about) {
  std::string code = about.notations.empty() ? std::string() : *about.notations.begin();
  if (code.empty() && !iri.starts_with("_:")) {
    std::string_view rest = iri;
    while (rest.ends_with('/') || rest.ends_with('#')) rest.remove_suffix(1);
    code = rest.substr(rest.find_last_of("/#:") + 1);
  }
  if (code.empty()) code = plainest(about.labels);
  if (code.empty()) code = "term";
  return std::string(first_bytes(code, kMaxCodeLength - 10));  // leaves space for a number
}

std::string iri_text(std::string_view text) {
  constexpr char kDigits[] = "0123456789ABCDEF";
  std::string out;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       c == '-' || c == '.' || c == '_' || c == '~' || byte >= 0x80;
    if (plain)
      out += c;
    else
      out.append({'%', kDigits[byte >> 4], kDigits[byte & 15]});
  }
  return out;
}

}  // namespace

Result<TermList> read_terms_skos(std::string_view text, RdfSyntax syntax) {
  Concepts read;
  bool too_much = false;
  STRATA_TRY(read_rdf(text, syntax,
                      [&](const Triple& triple) { return !(too_much = !read.take(triple)); }));
  auto& concepts = read.all();
  std::erase_if(concepts, [](const auto& entry) {
    return !entry.second.is_described || entry.second.is_other;
  });
  if (too_much || concepts.size() > kMaxTerms)
    return fail(ErrorCode::too_large, "Too many terms",
                "A term list can have at most " + std::to_string(kMaxTerms) + " terms.", "body");
  if (concepts.empty())
    return fail(ErrorCode::invalid, "No terms", "The file contains no skos:Concept.", "body");

  TermList list;
  list.rows = concepts.size();
  list.columns = {"code", "parent", "label", "definition", "uri"};
  std::map<std::string, std::string> codes;  // by IRI
  std::map<std::string, int> met;            // number of concepts with the same code
  std::set<std::string> used;
  for (const auto& [iri, about] : concepts) {
    const std::string requested = code_of(iri, about);
    int& n = met[requested];
    std::string code = ++n == 1 ? requested : requested + "-" + std::to_string(n);
    while (!used.insert(code).second) code = requested + "-" + std::to_string(++n);
    codes[iri] = std::move(code);
  }
  std::set<std::string> languages;
  for (const auto& [iri, about] : concepts) {
    Term term;
    term.code = codes.at(iri);
    term.label = plainest(about.labels);
    for (const auto& [language, labels] : about.labels) {
      list.left_out += labels.size() - 1;
      if (language.empty()) continue;
      if (!label_language(label_slug(language))) {
        list.left_out += 1;
        continue;
      }
      term.labels[language] = *labels.begin();
      languages.insert(language);
    }
    term.definition = plainest(about.definitions.empty() ? about.notes : about.definitions);
    if (!iri.starts_with("_:") && !iri.starts_with(kRelativeBase)) term.uri = iri;
    if (!about.broader.empty()) {
      // A parent that the file describes comes before parents to which the file only refers.
      auto parent =
          std::find_if(about.broader.begin(), about.broader.end(),
                       [&](const std::string& broader) { return codes.contains(broader); });
      if (parent != about.broader.end())
        term.parent = codes.at(*parent);
      else
        term.parent_uri = *about.broader.begin();
      list.left_out += about.broader.size() - 1;
    }
    if (auto good = check_term(term); good)
      list.terms.push_back(std::move(term));
    else if (list.mistakes.size() < kMaxTermMistakes)
      list.mistakes.push_back({0, term.code, good.error().field, good.error()});
  }
  if (languages.size() > kMaxTermLanguages)
    return fail(ErrorCode::invalid, "Too many languages",
                "A term list can have labels in at most " + std::to_string(kMaxTermLanguages) +
                    " languages.",
                "body");
  for (const auto& language : languages) list.columns.insert(label_slug(language));
  return list;
}

Result<std::string> terms_skos(const std::string& name, std::span<const Term> terms) {
  const auto iri_of = [](const Term& term) {
    return term.uri.empty() ? std::string(kRelativeBase) + "#" + iri_text(term.code) : term.uri;
  };
  std::map<std::string, std::string> iris;  // by code
  for (const Term& term : terms) iris[term.code] = iri_of(term);
  const std::string scheme = std::string(kRelativeBase) + "#";
  std::vector<Triple> triples{{scheme, kType, kSkos + "ConceptScheme", false},
                              {scheme, kSkos + "prefLabel", name, true}};
  for (const Term& term : terms) {
    const std::string& iri = iris.at(term.code);
    const auto say = [&](const char* property, const std::string& text,
                         const std::string& language) {
      if (!text.empty()) triples.push_back({iri, kSkos + property, text, true, language});
    };
    triples.push_back({iri, kType, kSkos + "Concept", false});
    triples.push_back({iri, kSkos + "inScheme", scheme, false});
    say("notation", term.code, {});
    say("prefLabel", term.label, {});
    for (const auto& [language, label] : term.labels) say("prefLabel", label, language);
    say("definition", term.definition, {});
    if (const auto parent = iris.find(term.parent); parent != iris.end())
      triples.push_back({iri, kSkos + "broader", parent->second, false});
  }
  const RdfPrefix prefixes[] = {{"skos", kSkos}};
  return write_turtle(triples, prefixes);
}

}  // namespace strata
