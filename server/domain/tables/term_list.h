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

// A table of a project is a list of terms if it has `code`, a required and unique text, `label`, a
// text, and `parent`, a term of the table itself. Other columns of a list are identified by their
// slugs, if their kind is suitable; null: the table does not have them.
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
// Points into the table. Nothing: not a list of terms.
std::optional<TermColumns> term_columns(const Table& table);

// Returns a column for a new list by its slug ("color", "label-es").
Column new_term_column(const std::string& slug);
// All columns of a new list, with labels in these languages.
std::vector<Column> new_term_columns(std::span<const std::string> languages);

// A term with its place in a list.
struct ListedTerm {
  std::int64_t key = 0;
  std::optional<std::int64_t> parent;
  int depth = 0;  // 0: at the top
  Term term;      // its parent by code
};
// Returns the terms as a flattened tree: each before its descendants, siblings by key. Terms whose
// parents are missing or in a cycle are at the top.
std::vector<ListedTerm> list_terms(const TermColumns& columns, std::span<const Record> records);

// Returns the term's label in a language ("es-mx"), its base language, no language or any language,
// otherwise its code.
std::string label_in(const Term& term, const std::string& language);

// Returns which terms contain all words of `text` in their code and labels of all languages,
// without regard to case and accents.
std::vector<bool> terms_with(std::span<const ListedTerm> terms, std::string_view text);

// Returns the colors and patterns of the terms by key, with their labels. A term without a color
// gets a shade of its parent's color; at the top the color is generated. Limited to the first
// kMaxTermColors by key.
inline constexpr std::size_t kMaxTermColors = 4096;
Palette terms_palette(std::span<const ListedTerm> terms);
// Whether a layer of a list of terms takes its colors from the terms: the palette has no points and
// no column.
bool takes_term_colors(const Palette& palette);

}  // namespace strata
