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

// Converts between the keys of a table's records and words. Terms have labels and codes. Other
// records have a title. The two directions are consistent: `key_of` returns the key for each result
// of `word`.
class RecordWords {
 public:
  // `language` is the language of the labels that `word` returns ("es-mx"). `key_of` accepts labels
  // in all languages. Blocks.
  static Result<RecordWords> load(store::Store& store, TableId table_id, Role seen_by,
                                  const std::string& language);

  // Returns the label or title of the record if it is unique. Otherwise returns the code or,
  // without a code, the key. Returns the key for a missing record.
  std::string word(std::int64_t key) const;
  // Returns the name of the record, which need not be unique. Returns an empty text if the record
  // has no name.
  std::string name(std::int64_t key) const;
  // Accepts digits as a key. Refuses (422) a word that belongs to no record or to several records.
  // `field` is the name of the cell.
  Result<std::int64_t> key_of(const std::string& word, const std::string& field) const;

 private:
  static std::string bare(const std::string& word);
  void add(std::int64_t key, const std::string& word);

  std::string table_;
  std::map<std::int64_t, std::string> names_, codes_;
  std::map<std::string, std::optional<std::int64_t>> keys_;  // by word; empty: ambiguous
};

// The words of the tables that columns of kind `term` refer to, by table. Several columns may refer
// to the same table.
using WordsOfTables = std::map<TableId, RecordWords>;
Result<WordsOfTables> words_of(store::Store& store, const std::vector<Column>& columns,
                               Role seen_by, const std::string& language);

}  // namespace strata::app
