#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "domain/layers/palette.h"
#include "domain/tables/table.h"
#include "domain/tables/term.h"

namespace strata {

// A table is a term list if it has the columns `code` (a required and unique text), `label` (a
// text) and `parent` (a term of the same table). The other columns of a term list are found by
// their slugs, if they have a suitable kind. A pointer is null if the table does not have the
// column.
struct TermColumns {
  const Column* code = nullptr;
  const Column* label = nullptr;
  const Column* parent = nullptr;
  const Column* definition = nullptr;             // text
  const Column* uri = nullptr;                    // url or text
  const Column* color = nullptr;                  // text
  const Column* pattern = nullptr;                // enumeration or text
  std::map<std::string, const Column*> labels{};  // by language: texts `label-es`
};
// The result points into the table. Returns nullopt if the table is not a term list.
std::optional<TermColumns> term_columns(const Table& table);

// Returns a column for a new term list by its slug ("color", "label-es").
Column new_term_column(const std::string& slug);
// Returns all columns of a new term list, with labels in these languages.
std::vector<Column> new_term_columns(std::span<const std::string> languages);

// A term and its position in a term list.
struct ListedTerm {
  std::int64_t key = 0;
  std::optional<std::int64_t> parent;
  int depth = 0;  // 0: at the top
  Term term;      // with the code of its parent
};
// Returns the terms as a flattened tree. Each term precedes its descendants, and siblings are
// ordered by key. A term without an existing parent is at the top. If terms form a cycle, the term
// with the lowest key is at the top.
std::vector<ListedTerm> list_terms(const TermColumns& columns, std::span<const Record> records);

// Returns the label of a term in a language ("es-mx"), or else in its base language, without a
// language, or in any language. If the term has no labels, returns its code.
std::string label_in(const Term& term, const std::string& language);

// Returns for each term whether its code and its labels in all languages contain all words of
// `text`. Ignores case and accents.
std::vector<bool> terms_with(std::span<const ListedTerm> terms, std::string_view text);

// Returns the colors, patterns and labels of the terms by key. A term without a color gets a shade
// of its parent's color. At the top, the color is generated. Limited to the first kMaxTermColors
// keys.
inline constexpr std::size_t kMaxTermColors = 4096;
Palette terms_palette(std::span<const ListedTerm> terms);
// Returns whether a layer with a term list takes its colors from the terms. This is the case if the
// palette has no points and no column.
bool takes_term_colors(const Palette& palette);

}  // namespace strata
