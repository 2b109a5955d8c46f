#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "app/records/record_words.h"
#include "core/ids.h"
#include "domain/tables/table.h"
#include "store/tables/table_changes.h"

// Records as CSV, the way spreadsheets have it: the first row names the columns.
namespace strata::app {

// A record's cell of CSV; empty where the column has no value. What a term names is said by its
// word where `words` has its table, otherwise by its key.
std::string record_cell(const Record& record, const Column& column, char separator,
                        const WordsOfTables& words = {});
// The word of a term's cell; nothing: it is no term, has none, or is not in `words`.
std::optional<std::string> term_word(const Record& record, const Column& column,
                                     const WordsOfTables& words);

// What records have beside their columns: a value for each of the names, record by record.
struct MeasuredRecords {
  std::vector<std::string> names{};
  std::vector<std::vector<double>> values{};
};
// With a semicolon between the cells numbers have a decimal comma, as in the countries whose Excel
// writes semicolons. Begins with a byte order mark.
std::string records_csv(const std::vector<Record>& records, const std::vector<Column>& columns,
                        const MeasuredRecords& measured, char separator,
                        const WordsOfTables& words = {});

struct RowMistake {
  int line = 0;
  std::string column;  // as the first row calls it; empty: of the whole row
  Error problem;
};

struct RecordRows {
  std::vector<store::RecordInput> records;
  std::vector<int> lines;                 // of each record
  std::map<ColumnId, std::string> heads;  // what the first row calls the columns, by id
  // the first hundred; those rows are not among the records
  std::vector<RowMistake> mistakes;
  std::size_t rows = 0;
};

// A head is `key`, `version` (of the record as it was read), a column's slug, name or label in any
// language, or, where no column is called so, `area_m2`, `length_m` or `point_count`, which are
// passed over. Rows without a key are new records. An Error where the text is no CSV or its first
// row cannot be understood. Terms are keys, or words of `words`.
Result<RecordRows> read_records_csv(std::string_view text, const Table& table,
                                    const WordsOfTables& words = {});

}  // namespace strata::app
