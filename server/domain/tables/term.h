#pragma once

#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "domain/tables/table.h"

namespace strata {

// A term as in the file of a term list, such as `flaking` with the parent `coming-off`. It refers
// to other terms by their codes.
struct Term {
  int line = 0;            // its line in the text, for CSV
  std::string code;        // unique in the list, not empty
  std::string parent;      // the code of the parent term; empty at the top
  std::string parent_uri;  // for SKOS: a parent outside the text, instead of `parent`
  std::string label;       // without a language
  Labels labels;           // by language tag in lowercase: "es", "pt-br"
  std::string definition;
  std::string uri;
  std::string color;    // "#rrggbb", or empty
  std::string pattern;  // one of kTermPatterns, or empty
};

inline constexpr std::size_t kMaxTerms = 100'000;
inline constexpr std::size_t kMaxCodeLength = 200;    // bytes
inline constexpr std::size_t kMaxTermLanguages = 50;  // per list
inline constexpr std::size_t kMaxTermMistakes = 100;  // maximum number of reported mistakes
// In the order of the enum Pattern.
inline constexpr const char* kTermPatterns[] = {"solid", "hatch", "dots", "outline"};

// A mistake in one term of an imported text.
struct TermMistake {
  int line = 0;  // 0 if the format has no lines
  std::string code;
  std::string column;
  Error problem;
};

// The terms of an imported text.
struct TermList {
  std::vector<Term> terms;  // the terms without mistakes
  // The slugs of the columns in the text. The import does not change other columns of a list.
  std::set<std::string> columns;
  std::vector<TermMistake> mistakes;  // the first kMaxTermMistakes
  std::size_t rows = 0;               // number of terms, including those with mistakes
  // For SKOS: the number of broader terms and of labels in one language that were left out, because
  // a term list holds only one of each.
  std::size_t left_out = 0;
};

// Converts between a language and the slug of its labels ("label-es"). The reverse returns nullopt
// for other slugs. Languages are tags in lowercase.
std::string label_slug(const std::string& language);
std::optional<std::string> label_language(std::string_view slug);

// Converts "#RGB" or "#rrggbb" in any case to "#rrggbb". Returns nullopt if the text is not a
// color.
std::optional<std::string> clean_color(std::string_view text);

// Checks that the code, color and pattern of a term are valid. Normalizes the color.
Result<void> check_term(Term& term);

}  // namespace strata
