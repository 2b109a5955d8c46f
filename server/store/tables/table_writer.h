#pragma once

#include <map>
#include <optional>
#include <vector>

#include "core/ids.h"
#include "domain/layers/palette.h"
#include "store/pg/pg.h"
#include "store/tables/table_changes.h"

// Tables within a transaction: shared by tables.cpp, records.cpp and layers.cpp.
namespace strata::store {

// A table with data that callers of Store do not receive.
struct OpenTable {
  Table table;              // `columns`: only visible ones
  std::vector<Column> all;  // also hidden ones, by id
  std::int64_t next_key = 1;
  Role seen_by = Role::owner;  // `table.columns` are those that this role sees
};
// `not_found` if there is no such table. lock_table: until the transaction ends, no other
// transaction changes a table of the project, so that keys which other tables name stay.
Result<OpenTable> read_table(PgConnection& connection, TableId id, Role seen_by = Role::owner);
Result<OpenTable> lock_table(PgConnection& connection, TableId id);

// Returns the column's cells: properties by name, and `hidden`.
Cells cells_of(const Column& column);

// Puts cells into columns, by id, and shows the columns that are then not hidden.
void put_cells(OpenTable& open, const std::map<ColumnId, Cells>& columns);

// An entry for the journal: the cells that it writes, by key and by column id. A record has
// `exists` and the ids of its columns.
struct TableEdit {
  std::string user, op;
  nlohmann::json record;
  std::map<std::int64_t, Cells> records;
  std::map<ColumnId, Cells> columns;
  // undo and redo: past values must fit the present columns
  bool checks_values = false;
};
// Applies the edit. Refused (conflict, `invalid`): a change that leaves a required value empty, a
// unique value twice, a key without its record, or a value that its column does not accept. The
// result lists problems of single records; then the caller must not commit.
Result<TableChange> apply_edit(PgConnection& connection, OpenTable& open, TableEdit edit);

// Inserts the column, hidden until an edit shows it.
Result<Column> insert_column(PgConnection& connection, const OpenTable& open, Column column);
// Checks `column` against the other columns of its table: free slug, known target. Sets its slug.
Result<void> fit_column(PgConnection& connection, const OpenTable& open, Column& column);

// Makes the table with its columns, which are not in its journal, because they are its first state.
// A column whose target is kOwnTable names records of the table itself.
Result<Table> insert_table(PgConnection& connection, Table table);

// Returns the colors of the terms of a term list; nothing if the table is not a term list.
// not_found: there is no such table.
Result<std::optional<Palette>> term_palette_of(PgConnection& connection, TableId table_id);

}  // namespace strata::store
