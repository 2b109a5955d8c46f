#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "core/ids.h"
#include "domain/people/role.h"
#include "domain/tables/table.h"
#include "store/store.h"

namespace strata::app {

// What the records of a table are called, and which record a word means: terms by their labels or
// codes, other records by their title. Words and what they mean belong together: what `word` says,
// `key_of` finds again.
class RecordWords {
 public:
  // `language`: of terms, the one whose labels are said ("es-mx"); those of all languages are
  // understood. Blocks.
  static Result<RecordWords> load(store::Store& store, TableId table_id, Role seen_by,
                                  const std::string& language);

  // Its label or title where that means no other record, then its code, then its key. Of a record
  // that is not there its key.
  std::string word(std::int64_t key) const;
  // What it is called, also where others are called the same; empty where it has no name.
  std::string name(std::int64_t key) const;
  // Digits are a key. Refused (422): a word that no record has, or that several have. `field` names
  // the cell.
  Result<std::int64_t> key_of(const std::string& word, const std::string& field) const;

 private:
  static std::string bare(const std::string& word);
  void add(std::int64_t key, const std::string& word);

  std::string table_;
  std::map<std::int64_t, std::string> names_, codes_;
  std::map<std::string, std::optional<std::int64_t>> keys_;  // by word; nothing: several have it
};

// The words of all tables that the columns of kind `term` name, by table; one table may be named by
// several.
using WordsOfTables = std::map<TableId, RecordWords>;
Result<WordsOfTables> words_of(store::Store& store, const std::vector<Column>& columns,
                               Role seen_by, const std::string& language);

}  // namespace strata::app
