#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "core/cell_history.h"
#include "core/table.h"
#include "store/pg.h"

// The rows of a project's table: records.t<id> with a column c<id> for each of its columns, hidden ones among them. A period has
// c<id>_first and c<id>_last beside it, its days (core/edtf), by which it is sorted. Every identifier in the statements made here is a
// number of ours; values travel as parameters.
namespace strata::store {

// What is asked of records: how they are sorted, by columns or (`column` 0) by key, and which part.
struct RecordOrder {
  std::int64_t column = 0;
  bool descending = false;
};

Result<void> make_rows_table(PgConnection& connection, std::int64_t table_id);
Result<void> drop_rows_table(PgConnection& connection, std::int64_t table_id);
Result<void> add_rows_column(PgConnection& connection, std::int64_t table_id, const Column& column);
// The index that keeps a column unique; dropping one that is not there is nothing.
Result<void> make_unique_index(PgConnection& connection, std::int64_t table_id, const Column& column);
Result<void> drop_unique_index(PgConnection& connection, std::int64_t table_id, const Column& column);

// `columns`: those whose values are read.
Result<std::vector<Record>> load_rows(PgConnection& connection, std::int64_t table_id,
                                      const std::vector<Column>& columns, std::span<const std::int64_t> keys);
Result<std::vector<Record>> load_all_rows(PgConnection& connection, std::int64_t table_id,
                                          const std::vector<Column>& columns);
Result<std::vector<Record>> load_page(PgConnection& connection, std::int64_t table_id,
                                      const std::vector<Column>& columns, std::span<const RecordOrder> order,
                                      std::int64_t limit, std::int64_t offset);
// The same of rows that are given (those of the past), so that they are sorted alike.
Result<std::vector<Record>> page_of_rows(PgConnection& connection, std::int64_t table_id,
                                         const std::vector<Column>& columns, std::span<const Record> rows,
                                         std::span<const RecordOrder> order, std::int64_t limit, std::int64_t offset);

Result<void> delete_rows(PgConnection& connection, std::int64_t table_id, std::span<const std::int64_t> keys);
Result<void> insert_rows(PgConnection& connection, std::int64_t table_id, const std::vector<Column>& columns,
                         std::span<const Record> rows);

// Of `rows`, which are about to be inserted: one whose value of the column a row in the table has already, or one before it.
struct Taken {
  std::size_t row = 0;
  std::int64_t by_key = 0;
  bool by_sent = false;  // of the rows themselves
};
Result<std::optional<Taken>> taken_value(PgConnection& connection, std::int64_t table_id, const Column& column,
                                         std::span<const Record> rows);
// Two records with the same value, where there are.
Result<std::optional<std::pair<std::int64_t, std::int64_t>>> twins(PgConnection& connection, std::int64_t table_id,
                                                                   const Column& column);
// Of the keys, ascending, those that no record has.
Result<std::vector<std::int64_t>> missing_rows(PgConnection& connection, std::int64_t table_id,
                                               std::span<const std::int64_t> keys);
// A record whose term or relation `column` names one of the keys, and that key.
Result<std::optional<std::pair<std::int64_t, std::int64_t>>> row_naming(PgConnection& connection, std::int64_t table_id,
                                                                        const Column& column,
                                                                        std::span<const std::int64_t> keys);

}  // namespace strata::store
