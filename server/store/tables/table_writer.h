#pragma once

#include <map>
#include <optional>
#include <vector>

#include "core/ids.h"
#include "domain/layers/palette.h"
#include "store/pg/pg.h"
#include "store/tables/table_changes.h"

// Functions for tables within a transaction, shared by tables.cpp, records.cpp and layers.cpp.
namespace strata::store {

// A table with data that callers of Store do not receive.
struct OpenTable {
  Table table;              // `columns` has only visible columns
  std::vector<Column> all;  // also hidden columns, by id
  std::int64_t next_key = 1;
  Role seen_by = Role::owner;  // this role sees `table.columns`
};
// Read a table. Return a `not_found` error if it does not exist. After lock_table, no other
// transaction can change a table of the project until the transaction ends, so keys that other
// tables name are not deleted.
Result<OpenTable> read_table(PgConnection& connection, TableId id, Role seen_by = Role::owner);
Result<OpenTable> lock_table(PgConnection& connection, TableId id);

// Returns the cells of a column: its properties by name, and `hidden`.
Cells cells_of(const Column& column);

// Writes cells into columns, by column id, and updates the visible columns of the table.
void put_cells(OpenTable& open, const std::map<ColumnId, Cells>& columns);

// An entry for the journal: the cells that it writes, by key and by column id. The cells of a
// record are `exists` and the ids of its columns.
struct TableEdit {
  std::string user, op;
  nlohmann::json record;
  std::map<std::int64_t, Cells> records;
  std::map<ColumnId, Cells> columns;
  // for undo and redo: past values must be valid for the current columns
  bool checks_values = false;
};
// Applies the edit. Returns a `conflict` or `invalid` error for a change after which a required
// value is empty, a unique value exists twice, a key has no record, or a column does not accept a
// value. If the result lists problems of single records, the caller must not commit.
Result<TableChange> apply_edit(PgConnection& connection, OpenTable& open, TableEdit edit);

// Inserts the column, which is hidden until an edit shows it.
Result<Column> insert_column(PgConnection& connection, const OpenTable& open, Column column);
// Checks that the slug of `column` is free in its table and that its target exists. Sets its slug.
Result<void> fit_column(PgConnection& connection, const OpenTable& open, Column& column);

// Makes the table with its columns. The columns are not in its journal, because they are its first
// state. A column with the target kOwnTable names records of the table itself.
Result<Table> insert_table(PgConnection& connection, Table table);

// Returns the colors of the terms of a term list, or nothing if the table is not a term list.
// Returns a `not_found` error if the table does not exist.
Result<std::optional<Palette>> term_palette_of(PgConnection& connection, TableId table_id);

}  // namespace strata::store
