#pragma once

#include <map>
#include <optional>
#include <vector>

#include "core/ids.h"
#include "domain/layers/palette.h"
#include "store/pg/pg.h"
#include "store/tables/table_changes.h"

// Tables within a transaction: what tables.cpp, records.cpp and layers.cpp have in common.
namespace strata::store {

// A table with what is not told of it.
struct OpenTable {
  Table table;              // `columns`: those that are not hidden
  std::vector<Column> all;  // hidden ones, too, by id
  std::int64_t next_key = 1;
  Role seen_by = Role::owner;  // `table.columns` are those that it sees
};
// `not_found` where there is none. Locked: until the transaction ends nobody else changes any table
// of the project, so that keys which other tables name stay.
Result<OpenTable> read_table(PgConnection& connection, TableId id, Role seen_by = Role::owner);
Result<OpenTable> lock_table(PgConnection& connection, TableId id);

// The columns' cells: properties by name, and `hidden`.
Cells cells_of(const Column& column);

// Puts cells into columns, by id, and shows those that are not hidden then.
void put_cells(OpenTable& open, const std::map<ColumnId, Cells>& columns);

// An entry for the journal: the cells that it writes, by key and by column id. A record has
// `exists` and its columns' ids.
struct TableEdit {
  std::string user, op;
  nlohmann::json record;
  std::map<std::int64_t, Cells> records;
  std::map<ColumnId, Cells> columns;
  // undo and redo: values of the past must fit the columns as they are now
  bool checks_values = false;
};
// Does it, and refuses (conflict, `invalid`) what would leave a required value empty, a unique one
// twice, a key without its record, a value that its column does not take. Problems of single
// records are told in the change, and then nothing may be committed.
Result<TableChange> apply_edit(PgConnection& connection, OpenTable& open, TableEdit edit);

// Inserts the column, hidden until an edit shows it.
Result<Column> insert_column(PgConnection& connection, const OpenTable& open, Column column);
// `column` with its table's other columns: free slug, known target. Gives it its place.
Result<void> fit_column(PgConnection& connection, const OpenTable& open, Column& column);

// Makes the table with its columns, which are not in its journal: there is nothing before them. A
// column whose target is kOwnTable names records of the table itself.
Result<Table> insert_table(PgConnection& connection, Table table);

// The colours of the terms of a list; nothing where the table is none. not_found: there is no
// table.
Result<std::optional<Palette>> term_palette_of(PgConnection& connection, TableId table_id);

}  // namespace strata::store
