#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "app/records/record_words.h"
#include "core/ids.h"
#include "domain/tables/table.h"
#include "store/tables/table_changes.h"

// Records as CSV, in the form of spreadsheets: the first row names the columns.
namespace strata::app {

// Returns a record's cell of CSV; empty if the column has no value. A term is shown by its word if
// `words` has its table, otherwise by its key.
std::string record_cell(const Record& record, const Column& column, char separator,
                        const WordsOfTables& words = {});
// Returns the word of a term's cell; nothing if it is not a term, has none, or is not in `words`.
std::optional<std::string> term_word(const Record& record, const Column& column,
                                     const WordsOfTables& words);

// Measures of records: a value for each of the names, record by record.
struct MeasuredRecords {
  std::vector<std::string> names{};
  std::vector<std::vector<double>> values{};
};
// If the separator is a semicolon, numbers have a decimal comma, as in the countries whose Excel
// writes semicolons. Begins with a byte order mark.
std::string records_csv(const std::vector<Record>& records, const std::vector<Column>& columns,
                        const MeasuredRecords& measured, char separator,
                        const WordsOfTables& words = {});

struct RowMistake {
  int line = 0;
  std::string column;  // its name in the first row; empty: the whole row
  Error problem;
};

struct RecordRows {
  std::vector<store::RecordInput> records;
  std::vector<int> lines;                 // of each record
  std::map<ColumnId, std::string> heads;  // the names of the columns in the first row, by id
  // the first hundred; `records` excludes these rows
  std::vector<RowMistake> mistakes;
  std::size_t rows = 0;
};

// A head is `key`, `version` (of the record when it was read), a column's slug, name or label in
// any language, or `area_m2`, `length_m` or `point_count`, which are ignored unless a column has
// that name. Rows without a key are new records. Terms are keys, or words of `words`. Error: the
// text is not CSV or its first row is invalid.
Result<RecordRows> read_records_csv(std::string_view text, const Table& table,
                                    const WordsOfTables& words = {});

}  // namespace strata::app
