#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/ids.h"
#include "domain/layers/key_numbers.h"
#include "domain/tables/cell_history.h"
#include "domain/tables/table.h"
#include "store/pg/pg.h"
#include "store/tables/records.h"

// The rows of a table of a project: records.t<id> with a column c<id> for each of its columns, also
// for hidden columns. A period also has c<id>_first and c<id>_last, its first and last day
// (core/text/edtf), by which it is sorted. Every identifier in these statements is a number that
// the server chose. Values are passed as parameters.
namespace strata::store {

// Sorts records by a column, or by key if `column` is 0.
struct RecordOrder {
  ColumnId column = 0;
  bool descending = false;
  // collation of texts (collation_of); if empty, case is ignored
  std::string collation{};
  // for terms: the keys of the named records, in order
  std::optional<std::vector<std::int64_t>> keys{};
};

// Returns the PostgreSQL collation for a language ("de-at"): the collation of the language, of its
// base language, or of all languages. Returns an empty text if PostgreSQL was built without ICU.
Result<std::string> collation_of(PgConnection& connection, const std::string& language);
// Returns the keys of the records of a table in reading order: in the order of the tree for a term
// list, otherwise by title.
Result<std::vector<std::int64_t>> keys_in_order(PgConnection& connection, TableId table_id,
                                                Role seen_by, const std::string& collation,
                                                int depth = 0);

Result<void> make_rows_table(PgConnection& connection, TableId table_id);
Result<void> drop_rows_table(PgConnection& connection, TableId table_id);
Result<void> add_rows_column(PgConnection& connection, TableId table_id, const Column& column);
// Make or drop the index that keeps a column unique. An index to drop may be missing.
Result<void> make_unique_index(PgConnection& connection, TableId table_id, const Column& column);
Result<void> drop_unique_index(PgConnection& connection, TableId table_id, const Column& column);

// Loads the rows with these keys. `columns` are the columns to read.
Result<std::vector<Record>> load_rows(PgConnection& connection, TableId table_id,
                                      const std::vector<Column>& columns,
                                      std::span<const std::int64_t> keys);
Result<std::vector<Record>> load_all_rows(PgConnection& connection, TableId table_id,
                                          const std::vector<Column>& columns);
// A part of the sorted rows.
struct RowsPage {
  std::vector<Record> rows;
  std::int64_t total = 0;                // number of rows where the condition is true
  std::optional<nlohmann::json> last{};  // RecordPage::last
};
struct RowsPart {
  std::int64_t limit = 100, offset = 0;
  std::optional<nlohmann::json> after{};  // RecordQuery::after
};
// Returns a part of the rows. `where` is a condition over a row `t` (record_sql), or empty for all
// rows; its parameters are the first of `params`. `past` are rows of another time, which replace
// the rows of the table.
Result<RowsPage> load_page(PgConnection& connection, TableId table_id,
                           const std::vector<Column>& columns,
                           const std::optional<std::vector<Record>>& past, const std::string& where,
                           Params params, std::span<const RecordOrder> order, const RowsPart& part);
// Returns the values of an expression (record_sql) by key, for the records where they are known.
// The value of a condition is 1 or 0.
Result<std::vector<KeyNumber>> load_numbers(PgConnection& connection, TableId table_id,
                                            const std::vector<Column>& columns,
                                            const std::optional<std::vector<Record>>& past,
                                            const std::string& number, Params params);

Result<void> delete_rows(PgConnection& connection, TableId table_id,
                         std::span<const std::int64_t> keys);
Result<void> insert_rows(PgConnection& connection, TableId table_id,
                         const std::vector<Column>& columns, std::span<const Record> rows);

// One of the rows to insert, if its value of the column already exists in the table or in an
// earlier row.
struct Taken {
  std::size_t row = 0;
  std::int64_t by_key = 0;
  bool by_sent = false;  // the other value is in one of the rows to insert
};
Result<std::optional<Taken>> taken_value(PgConnection& connection, TableId table_id,
                                         const Column& column, std::span<const Record> rows);
// Returns two records with the same value of the column, if there are any.
Result<std::optional<std::pair<std::int64_t, std::int64_t>>> twins(PgConnection& connection,
                                                                   TableId table_id,
                                                                   const Column& column);
// Returns the given keys that no record has, ascending.
Result<std::vector<std::int64_t>> missing_rows(PgConnection& connection, TableId table_id,
                                               std::span<const std::int64_t> keys);
// Returns a record that names one of the keys in `column`, a term or relation, and that key.
Result<std::optional<std::pair<std::int64_t, std::int64_t>>> row_naming(
    PgConnection& connection, TableId table_id, const Column& column,
    std::span<const std::int64_t> keys);

// Returns the keys of the records whose cell lists the attachment, ascending.
Result<std::vector<std::int64_t>> rows_holding(PgConnection& connection, TableId table_id,
                                               const Column& column, AttachmentId attachment);

}  // namespace strata::store
