#pragma once

#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "domain/tables/table.h"

namespace strata {

// A term of a list (flaking, below coming-off), as files have it: it names others by their codes.
struct Term {
  int line = 0;            // of CSV: where it stands in the text
  std::string code;        // unique in the list, not empty
  std::string parent;      // the code of another term; empty: at the top
  std::string parent_uri;  // of SKOS: of a term that is not in the text, in place of `parent`
  std::string label;       // of no language in particular
  Labels labels;           // by language tag in lower case: "es", "pt-br"
  std::string definition;
  std::string uri;
  std::string color;    // "#rrggbb" or empty
  std::string pattern;  // of kTermPatterns or empty
};

inline constexpr std::size_t kMaxTerms = 100'000;
inline constexpr std::size_t kMaxCodeLength = 200;    // bytes
inline constexpr std::size_t kMaxTermLanguages = 50;  // of a list
inline constexpr std::size_t kMaxTermMistakes = 100;  // that are told
// In the order of Pattern.
inline constexpr const char* kTermPatterns[] = {"solid", "hatch", "dots", "outline"};

// What is wrong with one term of a text.
struct TermMistake {
  int line = 0;  // 0: nothing there has lines
  std::string code;
  std::string column;
  Error problem;
};

// Terms as a text has them.
struct TermList {
  std::vector<Term> terms;  // those without mistakes
  // slugs of those that the text has: what it does not have stays as it is in a list
  std::set<std::string> columns;
  std::vector<TermMistake> mistakes;  // the first kMaxTermMistakes
  std::size_t rows = 0;               // terms, those with mistakes among them
  // of SKOS: further broader terms and further labels of a language, which a list has no place for
  std::size_t left_out = 0;
};

// "label-es" for a language's labels; the language of such a slug, nothing for another one.
// Languages are tags in lower case.
std::string label_slug(const std::string& language);
std::optional<std::string> label_language(std::string_view slug);

// "#RGB", "#rrggbb" in any case → "#rrggbb"; nothing: it is no colour.
std::optional<std::string> clean_color(std::string_view text);

// What a term says of itself is fit for a list: its code, its colour, its pattern. Puts the colour
// into its one form.
Result<void> check_term(Term& term);

}  // namespace strata
