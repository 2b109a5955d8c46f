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

// The rows of a project's table: records.t<id> with a column c<id> for each of its columns, hidden
// ones among them. A period has c<id>_first and c<id>_last beside it, its days (core/text/edtf), by
// which it is sorted. Every identifier in the statements made here is a number of ours; values
// travel as parameters.
namespace strata::store {

// What is asked of records: how they are sorted, by columns or (`column` 0) by key, and which part.
struct RecordOrder {
  ColumnId column = 0;
  bool descending = false;
  // of texts (collation_of); empty: without regard to case
  std::string collation{};
  std::optional<std::vector<std::int64_t>> keys{};  // of terms: what they name, in order
};

// PostgreSQL's collation for a language ("de-at"): of that, of the one that it is a kind of, or of
// all. Empty: it was built without ICU.
Result<std::string> collation_of(PgConnection& connection, const std::string& language);
// The keys of a table's records as people read them: of a list of terms its tree, of others by what
// they are called.
Result<std::vector<std::int64_t>> keys_in_order(PgConnection& connection, TableId table_id,
                                                Role seen_by, const std::string& collation,
                                                int depth = 0);

Result<void> make_rows_table(PgConnection& connection, TableId table_id);
Result<void> drop_rows_table(PgConnection& connection, TableId table_id);
Result<void> add_rows_column(PgConnection& connection, TableId table_id, const Column& column);
// The index that keeps a column unique; dropping one that is not there is nothing.
Result<void> make_unique_index(PgConnection& connection, TableId table_id, const Column& column);
Result<void> drop_unique_index(PgConnection& connection, TableId table_id, const Column& column);

// `columns`: those whose values are read.
Result<std::vector<Record>> load_rows(PgConnection& connection, TableId table_id,
                                      const std::vector<Column>& columns,
                                      std::span<const std::int64_t> keys);
Result<std::vector<Record>> load_all_rows(PgConnection& connection, TableId table_id,
                                          const std::vector<Column>& columns);
// A part of the rows, sorted. `where`: a condition over a row `t` (record_sql), empty for all,
// whose parameters are the first of `params`. `past`: rows that are read in place of the table's,
// those of another time.
struct RowsPage {
  std::vector<Record> rows;
  std::int64_t total = 0;                // of the rows where the condition holds
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
// The numbers of an expression (record_sql) by key, where they are known; truths are 1 or 0.
Result<std::vector<KeyNumber>> load_numbers(PgConnection& connection, TableId table_id,
                                            const std::vector<Column>& columns,
                                            const std::optional<std::vector<Record>>& past,
                                            const std::string& number, Params params);

Result<void> delete_rows(PgConnection& connection, TableId table_id,
                         std::span<const std::int64_t> keys);
Result<void> insert_rows(PgConnection& connection, TableId table_id,
                         const std::vector<Column>& columns, std::span<const Record> rows);

// Of `rows`, which are about to be inserted: one whose value of the column a row in the table has
// already, or one before it.
struct Taken {
  std::size_t row = 0;
  std::int64_t by_key = 0;
  bool by_sent = false;  // of the rows themselves
};
Result<std::optional<Taken>> taken_value(PgConnection& connection, TableId table_id,
                                         const Column& column, std::span<const Record> rows);
// Two records with the same value, where there are.
Result<std::optional<std::pair<std::int64_t, std::int64_t>>> twins(PgConnection& connection,
                                                                   TableId table_id,
                                                                   const Column& column);
// Of the keys, ascending, those that no record has.
Result<std::vector<std::int64_t>> missing_rows(PgConnection& connection, TableId table_id,
                                               std::span<const std::int64_t> keys);
// A record whose term or relation `column` names one of the keys, and that key.
Result<std::optional<std::pair<std::int64_t, std::int64_t>>> row_naming(
    PgConnection& connection, TableId table_id, const Column& column,
    std::span<const std::int64_t> keys);

// Keys of the records whose cell lists the attachment, ascending.
Result<std::vector<std::int64_t>> rows_holding(PgConnection& connection, TableId table_id,
                                               const Column& column, AttachmentId attachment);

}  // namespace strata::store
