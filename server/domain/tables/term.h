#pragma once

#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "domain/tables/table.h"

namespace strata {

// A term of a list (flaking, below coming-off), as in files: it names other terms by their codes.
struct Term {
  int line = 0;            // of CSV: its line in the text
  std::string code;        // unique in the list, not empty
  std::string parent;      // the code of another term; empty: at the top
  std::string parent_uri;  // of SKOS: of a term outside the text, instead of `parent`
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
inline constexpr std::size_t kMaxTermMistakes = 100;  // reported at most
// In the order of Pattern.
inline constexpr const char* kTermPatterns[] = {"solid", "hatch", "dots", "outline"};

// A mistake in one term of a text.
struct TermMistake {
  int line = 0;  // 0: the format has no lines
  std::string code;
  std::string column;
  Error problem;
};

// The terms of a text.
struct TermList {
  std::vector<Term> terms;  // those without mistakes
  // slugs of the columns in the text; other columns of a list stay unchanged
  std::set<std::string> columns;
  std::vector<TermMistake> mistakes;  // the first kMaxTermMistakes
  std::size_t rows = 0;               // terms, including those with mistakes
  // of SKOS: additional broader terms and labels of a language, which a list cannot hold
  std::size_t left_out = 0;
};

// "label-es" for a language's labels; the reverse returns nothing for another slug. Languages are
// tags in lower case.
std::string label_slug(const std::string& language);
std::optional<std::string> label_language(std::string_view slug);

// "#RGB", "#rrggbb" in any case → "#rrggbb"; nothing: not a color.
std::optional<std::string> clean_color(std::string_view text);

// Checks that a term's code, color and pattern are valid in a list. Normalizes the color.
Result<void> check_term(Term& term);

}  // namespace strata
