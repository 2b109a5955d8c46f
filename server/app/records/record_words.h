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

// Translates between the keys of a table's records and words: terms have labels and codes, other
// records a title. The two directions agree: `key_of` finds the key of every result of `word`.
class RecordWords {
 public:
  // `language`: of the labels that `word` returns ("es-mx"); `key_of` accepts those of all
  // languages. Blocks.
  static Result<RecordWords> load(store::Store& store, TableId table_id, Role seen_by,
                                  const std::string& language);

  // Returns the record's label or title if it is unique, otherwise its code, otherwise its key. For
  // a missing record, its key.
  std::string word(std::int64_t key) const;
  // Returns the record's name, which may not be unique; empty if it has none.
  std::string name(std::int64_t key) const;
  // Digits are a key. Refuses (422) a word of no record or of several. `field` names the cell.
  Result<std::int64_t> key_of(const std::string& word, const std::string& field) const;

 private:
  static std::string bare(const std::string& word);
  void add(std::int64_t key, const std::string& word);

  std::string table_;
  std::map<std::int64_t, std::string> names_, codes_;
  std::map<std::string, std::optional<std::int64_t>> keys_;  // by word; nothing: ambiguous
};

// The words of all tables that the columns of kind `term` refer to, by table; several columns may
// refer to one table.
using WordsOfTables = std::map<TableId, RecordWords>;
Result<WordsOfTables> words_of(store::Store& store, const std::vector<Column>& columns,
                               Role seen_by, const std::string& language);

}  // namespace strata::app
