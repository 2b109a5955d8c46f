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

// The rows of a project's table: records.t<id> with a column c<id> for each of its columns, also
// for hidden ones. A period also has c<id>_first and c<id>_last, its days (core/text/edtf), which
// sort it. Every identifier in these statements is a number that the server chose; values are
// passed as parameters.
namespace strata::store {

// Sorts records by a column or (`column` 0) by key.
struct RecordOrder {
  ColumnId column = 0;
  bool descending = false;
  // of texts (collation_of); empty: ignoring case
  std::string collation{};
  std::optional<std::vector<std::int64_t>> keys{};  // of terms: the named records, in order
};

// Returns PostgreSQL's collation for a language ("de-at"): for the language, for its base language,
// or for all languages. Empty: PostgreSQL was built without ICU.
Result<std::string> collation_of(PgConnection& connection, const std::string& language);
// Returns the keys of a table's records in reading order: the tree of a term list, otherwise by
// title.
Result<std::vector<std::int64_t>> keys_in_order(PgConnection& connection, TableId table_id,
                                                Role seen_by, const std::string& collation,
                                                int depth = 0);

Result<void> make_rows_table(PgConnection& connection, TableId table_id);
Result<void> drop_rows_table(PgConnection& connection, TableId table_id);
Result<void> add_rows_column(PgConnection& connection, TableId table_id, const Column& column);
// The index that keeps a column unique; dropping a missing index has no effect.
Result<void> make_unique_index(PgConnection& connection, TableId table_id, const Column& column);
Result<void> drop_unique_index(PgConnection& connection, TableId table_id, const Column& column);

// `columns`: the columns to read.
Result<std::vector<Record>> load_rows(PgConnection& connection, TableId table_id,
                                      const std::vector<Column>& columns,
                                      std::span<const std::int64_t> keys);
Result<std::vector<Record>> load_all_rows(PgConnection& connection, TableId table_id,
                                          const std::vector<Column>& columns);
// A part of the rows, sorted. `where`: a condition over a row `t` (record_sql), empty for all,
// whose parameters are the first of `params`. `past`: rows of another time, read in place of the
// table's rows.
struct RowsPage {
  std::vector<Record> rows;
  std::int64_t total = 0;                // of the rows where the condition is true
  std::optional<nlohmann::json> last{};  // RecordPage::last
};
struct RowsPart {
  std::int64_t limit = 100, offset = 0;
  std::optional<nlohmann::json> after{};  // RecordQuery::after
};
Result<RowsPage> load_page(PgConnection& connection, TableId table_id,
                           const std::vector<Column>& columns,
                           const std::optional<std::vector<Record>>& past, const std::string& where,
                           Params params, std::span<const RecordOrder> order, const RowsPart& part);
// Returns the numbers of an expression (record_sql) by key, where they are known; truths are 1 or
// 0.
Result<std::vector<KeyNumber>> load_numbers(PgConnection& connection, TableId table_id,
                                            const std::vector<Column>& columns,
                                            const std::optional<std::vector<Record>>& past,
                                            const std::string& number, Params params);

Result<void> delete_rows(PgConnection& connection, TableId table_id,
                         std::span<const std::int64_t> keys);
Result<void> insert_rows(PgConnection& connection, TableId table_id,
                         const std::vector<Column>& columns, std::span<const Record> rows);

// Of `rows`, which are to be inserted: one whose value of the column already exists, in the table
// or in an earlier row.
struct Taken {
  std::size_t row = 0;
  std::int64_t by_key = 0;
  bool by_sent = false;  // in one of `rows`
};
Result<std::optional<Taken>> taken_value(PgConnection& connection, TableId table_id,
                                         const Column& column, std::span<const Record> rows);
// Returns two records with the same value, if there are any.
Result<std::optional<std::pair<std::int64_t, std::int64_t>>> twins(PgConnection& connection,
                                                                   TableId table_id,
                                                                   const Column& column);
// Returns those of the keys, ascending, that no record has.
Result<std::vector<std::int64_t>> missing_rows(PgConnection& connection, TableId table_id,
                                               std::span<const std::int64_t> keys);
// Returns a record whose term or relation `column` names one of the keys, and that key.
Result<std::optional<std::pair<std::int64_t, std::int64_t>>> row_naming(
    PgConnection& connection, TableId table_id, const Column& column,
    std::span<const std::int64_t> keys);

// Returns the keys of the records whose cell lists the attachment, ascending.
Result<std::vector<std::int64_t>> rows_holding(PgConnection& connection, TableId table_id,
                                               const Column& column, AttachmentId attachment);

}  // namespace strata::store
