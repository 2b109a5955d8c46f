#include "vocabulary/terms_csv.h"

#include <algorithm>
#include <map>

#include "core/text/ascii.h"
#include "core/text/csv.h"

namespace strata {
namespace {

constexpr std::pair<const char*, std::string Term::*> kParts[] = {
    {"code", &Term::code},      {"parent", &Term::parent},
    {"label", &Term::label},    {"definition", &Term::definition},
    {"uri", &Term::uri},        {"color", &Term::color},
    {"pattern", &Term::pattern}};

// The meaning of a column: a part of a term, or the labels in one language.
struct Head {
  std::string slug;
  std::string Term::*part = nullptr;
  std::string language;
};

std::optional<Head> head_of(const std::string& cell) {
  Head head{std::string(trimmed(cell)), nullptr, {}};
  std::transform(head.slug.begin(), head.slug.end(), head.slug.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  for (const auto& [name, part] : kParts)
    if (head.slug == name) head.part = part;
  if (head.part) return head;
  const auto language = label_language(head.slug);
  if (!language) return std::nullopt;
  head.language = *language;
  return head;
}

Result<std::vector<Head>> read_heads(const CsvRow& row, TermList& list) {
  std::vector<Head> heads;
  std::size_t languages = 0;
  for (const std::string& cell : row.cells) {
    auto head = head_of(cell);
    if (!head)
      return fail(ErrorCode::invalid, "Unknown column",
                  "\"" + cell +
                      "\" is not one of code, parent, label, label-es (or another language), "
                      "definition, uri, color, pattern.",
                  "body");
    if (!list.columns.insert(head->slug).second)
      return fail(ErrorCode::invalid, "Duplicate column",
                  "\"" + head->slug + "\" appears twice in the first row.", "body");
    languages += !head->language.empty();
    heads.push_back(std::move(*head));
  }
  if (!list.columns.contains("code"))
    return fail(ErrorCode::invalid, "Column missing",
                "The first row must contain the column `code`.", "body");
  if (languages > kMaxTermLanguages)
    return fail(ErrorCode::invalid, "Too many languages",
                "A term list can have labels in at most " + std::to_string(kMaxTermLanguages) +
                    " languages.",
                "body");
  return heads;
}

}  // namespace

Result<TermList> read_terms_csv(std::string_view text) {
  auto csv =
      STRATA_TRY(parse_csv(text, {kMaxTerms + 1, std::size(kParts) + kMaxTermLanguages + 1}));
  if (csv.rows.empty())
    return fail(ErrorCode::invalid, "Empty table",
                "The text is empty. Its first row must contain the column names.", "body");
  TermList list;
  auto heads = STRATA_TRY(read_heads(csv.rows.front(), list));
  list.rows = csv.rows.size() - 1;
  std::map<std::string, int> lines;
  for (std::size_t r = 1; r < csv.rows.size(); ++r) {
    const CsvRow& row = csv.rows[r];
    Term term;
    term.line = row.line;
    for (std::size_t c = 0; c < std::min(row.cells.size(), heads.size()); ++c) {
      const Head& head = heads[c];
      std::string value = unguard_formula(std::string(trimmed(row.cells[c])));
      if (head.part)
        term.*head.part = std::move(value);
      else if (!value.empty())
        term.labels[head.language] = std::move(value);
    }
    Result<void> good;
    if (row.cells.size() != heads.size())
      good = fail(ErrorCode::invalid, "Wrong number of cells",
                  "The row has " + std::to_string(row.cells.size()) +
                      " cells, but the first row has " + std::to_string(heads.size()) + ".");
    if (good) good = check_term(term);
    if (good)
      if (const auto [first, is_new] = lines.emplace(term.code, row.line); !is_new)
        good = fail(
            ErrorCode::invalid, "Duplicate code",
            "\"" + term.code + "\" also appears in line " + std::to_string(first->second) + ".",
            "code");
    if (good)
      list.terms.push_back(std::move(term));
    else if (list.mistakes.size() < kMaxTermMistakes)
      list.mistakes.push_back({row.line, term.code, good.error().field, good.error()});
  }
  return list;
}

std::string terms_csv(std::span<const Term> terms, char separator) {
  std::set<std::string> languages;
  for (const Term& term : terms)
    for (const auto& [language, label] : term.labels) languages.insert(language);
  std::vector<std::string> cells{"code", "parent", "label"};
  for (const auto& language : languages) cells.push_back(label_slug(language));
  cells.insert(cells.end(), {"definition", "uri", "color", "pattern"});
  std::string text(kUtf8Mark);
  text += csv_line(cells, separator);
  for (const Term& term : terms) {
    cells = {term.code, term.parent, term.label};
    for (const auto& language : languages) {
      const auto label = term.labels.find(language);
      cells.push_back(label == term.labels.end() ? std::string() : label->second);
    }
    cells.insert(cells.end(), {term.definition, term.uri, term.color, term.pattern});
    for (std::string& cell : cells) cell = guard_formula(std::move(cell));
    text += csv_line(cells, separator);
  }
  return text;
}

}  // namespace strata
