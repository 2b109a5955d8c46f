#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "app/records/record_words.h"
#include "core/ids.h"
#include "domain/tables/table.h"
#include "store/tables/table_changes.h"

// Records as CSV, in the layout of spreadsheets. The first row contains the names of the columns.
namespace strata::app {

// Returns the CSV cell of a record. It is empty if the column has no value. For a term, the
// cell contains the word if `words` contains the table of the term, and otherwise the key.
std::string record_cell(const Record& record, const Column& column, char separator,
                        const WordsOfTables& words = {});
// Returns the word for a cell with a term. Returns nothing if the cell contains no term, if the
// term has no word, or if `words` does not contain it.
std::optional<std::string> term_word(const Record& record, const Column& column,
                                     const WordsOfTables& words);

// Measures of records, with a value for each name and record.
struct MeasuredRecords {
  std::vector<std::string> names{};
  std::vector<std::vector<double>> values{};
};
// Returns CSV that begins with a byte order mark. With a semicolon as separator, numbers have a
// decimal comma, as in the countries where Excel writes semicolons.
std::string records_csv(const std::vector<Record>& records, const std::vector<Column>& columns,
                        const MeasuredRecords& measured, char separator,
                        const WordsOfTables& words = {});

struct RowMistake {
  int line = 0;
  std::string column;  // name in the first row; empty for the whole row
  Error problem;
};

struct RecordRows {
  std::vector<store::RecordInput> records;
  std::vector<int> lines;                 // line of each record
  std::map<ColumnId, std::string> heads;  // column names in the first row, by column id
  // The first hundred mistakes. `records` does not contain their rows.
  std::vector<RowMistake> mistakes;
  std::size_t rows = 0;
};

// Reads records from CSV. The name of a column is `key`, `version` (of the record when it was
// read), or the slug, name or label of a table column in any language. `area_m2`, `length_m` and
// `point_count` are ignored unless a table column has that name. A row without a key is a new
// record. Cells of terms contain keys, or words in `words`. Returns an error if the text is not
// CSV or its first row is invalid.
Result<RecordRows> read_records_csv(std::string_view text, const Table& table,
                                    const WordsOfTables& words = {});

}  // namespace strata::app
