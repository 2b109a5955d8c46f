#include "app/records/record_words.h"

#include <algorithm>

#include "core/text/ascii.h"
#include "core/text/number_text.h"
#include "core/text/slug.h"
#include "domain/tables/column_value.h"
#include "domain/tables/term_list.h"
#include "store/tables/records.h"

namespace strata::app {
namespace {

constexpr int kDeepest = 3;  // tables may refer to each other, even in cycles

std::map<std::int64_t, std::string> titles_of(store::Store& store, const store::RecordPage& page,
                                              Role seen_by, const std::string& language,
                                              int depth) {
  std::map<std::int64_t, std::string> names;
  const Column* title = name_column(page.table);
  if (!title) return names;
  std::map<std::int64_t, std::string> named;  // names of the records that the titles contain
  if (title->kind == ColumnKind::term && depth < kDeepest) {
    store::RecordQuery all;
    all.limit = store::kMaxRecords;
    if (const auto target = store.records().page(*title->target, seen_by, all)) {
      if (const auto terms = term_columns(target->table))
        for (const ListedTerm& listed : list_terms(*terms, target->records))
          named[listed.key] = label_in(listed.term, language);
      else
        named = titles_of(store, *target, seen_by, language, depth + 1);
    }
  }
  for (const Record& record : page.records) {
    const auto value = record.values.find(title->id);
    if (value == record.values.end() || value->second.is_null()) continue;
    if (title->kind != ColumnKind::term)
      names[record.key] = print_value(*title, value->second);
    else if (const auto name = named.find(value->second.get<std::int64_t>()); name != named.end())
      names[record.key] = name->second;
  }
  return names;
}

}  // namespace

// Removes blanks at both ends because spreadsheets also remove them from cells.
std::string RecordWords::bare(const std::string& word) { return std::string(trimmed(word)); }

void RecordWords::add(std::int64_t key, const std::string& word) {
  if (bare(word).empty() || is_all_digits(bare(word))) return;
  const auto [known, is_new] = keys_.try_emplace(bare(word), key);
  if (!is_new && known->second != key) known->second.reset();
}

Result<RecordWords> RecordWords::load(store::Store& store, TableId table_id, Role seen_by,
                                      const std::string& language) {
  store::RecordQuery all;
  all.limit = store::kMaxRecords;
  const auto page = STRATA_TRY(store.records().page(table_id, seen_by, all));
  RecordWords words;
  words.table_ = page.table.name;
  if (const auto terms = term_columns(page.table)) {
    for (const ListedTerm& listed : list_terms(*terms, page.records)) {
      words.names_[listed.key] = label_in(listed.term, language);
      words.codes_[listed.key] = listed.term.code;
      words.add(listed.key, listed.term.code);
      words.add(listed.key, label_in(listed.term, language));
    }
    for (const Record& record : page.records) {
      const auto add_text = [&](const Column* column) {
        const auto text = column ? record.values.find(column->id) : record.values.end();
        if (text != record.values.end() && text->second.is_string())
          words.add(record.key, text->second.get<std::string>());
      };
      add_text(terms->label);
      for (const auto& [tag, column] : terms->labels) add_text(column);
    }
    return words;
  }
  words.names_ = titles_of(store, page, seen_by, language, 0);
  for (const auto& [key, name] : words.names_) words.add(key, name);
  return words;
}

std::string RecordWords::name(std::int64_t key) const {
  const auto found = names_.find(key);
  return found == names_.end() ? std::string() : found->second;
}

std::string RecordWords::word(std::int64_t key) const {
  for (const auto* words : {&names_, &codes_}) {
    const auto said = words->find(key);
    if (said == words->end()) continue;
    const auto meant = keys_.find(bare(said->second));
    if (meant != keys_.end() && meant->second == key) return said->second;
  }
  return std::to_string(key);
}

Result<std::int64_t> RecordWords::key_of(const std::string& word, const std::string& field) const {
  if (is_all_digits(bare(word))) return parse_integer(bare(word), 0, kMaxRecordKey, field);
  const auto meant = keys_.find(bare(word));
  if (meant == keys_.end())
    return fail(ErrorCode::invalid, "Record not found",
                table_ + " has no record with the name \"" + word.substr(0, 100) + "\".", field);
  if (!meant->second)
    return fail(ErrorCode::invalid, "Ambiguous name",
                table_ + " has several records with the name \"" + word.substr(0, 100) +
                    "\". Use the code or the key of the record instead.",
                field);
  return *meant->second;
}

Result<WordsOfTables> words_of(store::Store& store, const std::vector<Column>& columns,
                               Role seen_by, const std::string& language) {
  WordsOfTables all;
  for (const Column& column : columns) {
    if (column.kind != ColumnKind::term || !column.target || all.contains(*column.target)) continue;
    auto words = STRATA_TRY(RecordWords::load(store, *column.target, seen_by, language));
    all.emplace(*column.target, std::move(words));
  }
  return all;
}

}  // namespace strata::app
