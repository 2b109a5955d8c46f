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

// A table of a project is a list of terms where it has `code`, a text that is required and unique,
// `label`, a text, and `parent`, a term of the table itself. Other columns of a list are known by
// their slugs, where their kind fits; null: the table does not have them.
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
// Points into the table. Nothing: it is no list of terms.
std::optional<TermColumns> term_columns(const Table& table);

// A column of a list by its slug ("color", "label-es"), as a table that is being made gets it.
Column new_term_column(const std::string& slug);
// All columns of a new list, with labels in these languages.
std::vector<Column> new_term_columns(std::span<const std::string> languages);

// A term in its place in a list.
struct ListedTerm {
  std::int64_t key = 0;
  std::optional<std::int64_t> parent;
  int depth = 0;  // 0: at the top
  Term term;      // its parent by code
};
// The terms as a tree that is written down: each before those below it, siblings by key. Those
// whose parents are in a circle or not there stand at the top.
std::vector<ListedTerm> list_terms(const TermColumns& columns, std::span<const Record> records);

// What the term is called in a language ("es-mx"): in that one, in the one that it is a kind of, in
// none, in any, or by its code.
std::string label_in(const Term& term, const std::string& language);

// Which terms have all words of `text` in their code and their labels, whatever the language, the
// case and the accents.
std::vector<bool> terms_with(std::span<const ListedTerm> terms, std::string_view text);

// The colours and patterns of the terms by their keys, with their labels. A term without a colour
// takes the one above it, in a shade of its own; at the top it is generated. The first
// kMaxTermColors by key.
inline constexpr std::size_t kMaxTermColors = 4096;
Palette terms_palette(std::span<const ListedTerm> terms);
// Whether a layer of a list of terms takes its colours from them: it has no points of its own, and
// no column that colours.
bool takes_term_colors(const Palette& palette);

}  // namespace strata
