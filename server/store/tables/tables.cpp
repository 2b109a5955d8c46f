#include <algorithm>
#include <set>

#include "domain/tables/column_value.h"
#include "domain/tables/term_list.h"
#include "store/content/layers.h"
#include "store/pg/blobs.h"
#include "store/store_impl.h"
#include "store/tables/table_rows.h"
#include "store/tables/table_writer.h"
#include "store/tables/tables.h"

namespace strata::store {
namespace {

Result<Table> table_of(PgConnection& connection, TableId id, Role seen_by = Role::owner) {
  auto open = STRATA_TRY(read_table(connection, id, seen_by));
  return std::move(open.table);
}

// Returns a visible column. Returns an error if the table has no such column, and a `stale` error
// for a version that differs from the version of the table.
Result<const Column*> shown_column(const OpenTable& open, ColumnId column_id,
                                   std::optional<std::int64_t> version) {
  if (version && *version != open.table.version) return stale("table");
  for (const Column& column : open.table.columns)
    if (column.id == column_id) return &column;
  return no_such("column", to_string(column_id));
}

Result<TableChange> refused_by_records(Result<TableChange> change) {
  if (change && !change->problems.empty()) return tl::unexpected(change->problems.front().problem);
  return change;
}

// Moves the values of a column to a new column that replaces it. The entry lists the records that
// lose values.
Result<TableChange> retype(PgConnection& connection, OpenTable& open, const Column& old,
                           Column column, const std::string& user) {
  auto made = STRATA_TRY(insert_column(connection, open, std::move(column)));
  open.all.push_back(made);
  TableEdit edit{user, "retype-column", {{"column", made.id}, {"from", old.id}}, {}, {}};
  edit.columns[old.id] = {{"hidden", true}};
  edit.columns[made.id] = {{"hidden", false}};
  auto rows = STRATA_TRY(load_all_rows(connection, open.table.id, {old}));
  nlohmann::json lost = nlohmann::json::array();
  std::int64_t converted = 0, lost_count = 0;
  Column lenient = made;
  lenient.required = false;
  for (const Record& row : rows) {
    const auto value = row.values.find(old.id);
    if (value == row.values.end()) continue;
    auto then = convert_value(old, lenient, value->second, {});
    if (then && !then->is_null()) {
      edit.records[row.key][to_string(made.id)] = std::move(*then);
      ++converted;
    } else {
      ++lost_count;
      if (lost.size() < kMaxRowProblems) lost.push_back(row.key);
    }
  }
  edit.record["converted"] = converted;
  edit.record["lost"] = lost_count;
  edit.record["lost_keys"] = std::move(lost);
  return refused_by_records(apply_edit(connection, open, std::move(edit)));
}

}  // namespace

Result<std::vector<Table>> Tables::of_project(ProjectId project_id, Role seen_by) {
  return pool_.read([&](PgConnection& connection) -> Result<std::vector<Table>> {
    auto rows = STRATA_TRY(connection.query(
        "SELECT id FROM record_tables WHERE project_id = $1 ORDER BY lower(name), id",
        Params().id(project_id)));
    std::vector<Table> tables;
    for (int i = 0; i < rows.rows(); ++i) {
      auto table = table_of(connection, rows.id<TableId>(i, 0), seen_by);
      // the table was deleted after the list was read
      if (!table && table.error().code == ErrorCode::not_found) continue;
      if (!table) return tl::unexpected(table.error());
      tables.push_back(std::move(*table));
    }
    return tables;
  });
}

Result<Table> Tables::find(const std::string& ref, Role seen_by) {
  if (!check_text(ref, "table")) return no_such("table", ref);
  return pool_.read([&](PgConnection& connection) -> Result<Table> {
    if (const auto id = id_of<TableId>(ref)) return table_of(connection, *id, seen_by);
    auto row = STRATA_TRY(
        connection.query("SELECT id FROM record_tables WHERE slug = $1", Params().text(ref)));
    if (row.rows() == 0) return no_such("table", ref);
    return table_of(connection, row.id<TableId>(0, 0), seen_by);
  });
}

Result<Table> Tables::create(const Table& table, const IdempotentResponse<Table>& answer) {
  return change(pool_, answer,
                [&](PgConnection& connection) { return insert_table(connection, table); });
}

Result<Table> Tables::update(const Table& table, const IdempotentResponse<Table>& answer) {
  STRATA_TRY(check_name(table.name));
  STRATA_TRY(check_text(table.description, "description"));
  STRATA_TRY(check_labels(table.labels));
  return change(pool_, answer, [&](PgConnection& connection) -> Result<Table> {
    // Lock the table, as for every other change. No other transaction may change the rows while the
    // view for analysts is made with the new name.
    auto open = STRATA_TRY(lock_table(connection, table.id));
    if (table.title_column && table.title_column != open.table.title_column) {
      const auto title = std::ranges::find(open.table.columns, *table.title_column, &Column::id);
      if (title == open.table.columns.end())
        return fail(ErrorCode::invalid, "Column not found",
                    "The table has no column " + to_string(*table.title_column) + ".",
                    "title_column");
      if (!can_be_title(*title))
        return fail(
            ErrorCode::invalid, "Invalid title column",
            "The column '" + title->name +
                "' cannot be the title of a record. Choose a column that contains only one text, "
                "number, date or term in each record.",
            "title_column");
    }
    auto row = STRATA_TRY(connection.query(
        "UPDATE record_tables SET name = $3, labels = $4, description = $5, title_column = $6, version = version + 1 "
        "WHERE id = $1 AND version = $2 RETURNING id",
        Params()
            .id(table.id)
            .integer(table.version)
            .text(table.name)
            .json(table.labels)
            .text(table.description)
            .optional_id(table.title_column)));
    auto now = table_of(connection, table.id);
    if (!now) return now;
    return row.rows() > 0 ? now : Result<Table>(stale("table"));
  });
}

Result<void> Tables::remove(TableId id, const IdempotentResponse<>& answer) {
  auto gone = change(pool_, answer, [&](PgConnection& connection) -> Result<void> {
    STRATA_TRY(lock_table(connection, id));
    // Erase the layers that were erased from the Trash but still have content, because the table
    // cannot be deleted while they exist.
    auto layers = STRATA_TRY(connection.query(
        "SELECT l.id FROM all_layers l JOIN all_models m ON m.id = l.model_id WHERE l.table_id = $1 AND (l.erasing OR m.erasing)",
        Params().id(id)));
    for (int i = 0; i < layers.rows(); ++i)
      STRATA_TRY(erase_layer(connection, layers.id<LayerId>(i, 0)));
    auto users = STRATA_TRY(connection.query(
        "SELECT 'the layer ' || l.name || ' of ' || m.name, coalesce(l.binned, m.binned) IS NOT NULL "
        "FROM all_layers l JOIN all_models m ON m.id = l.model_id "
        "WHERE l.table_id = $1 UNION ALL "
        "SELECT 'the column ' || (c.properties ->> 'name') || ' of ' || t.name, false FROM record_columns c "
        "JOIN record_tables t ON t.id = c.table_id WHERE c.target = $1 AND c.table_id <> $1 "
        "ORDER BY 2 LIMIT 1",
        Params().id(id)));
    if (users.rows() > 0 && users.boolean(0, 1))
      return fail(ErrorCode::conflict, "Table in use",
                  "This table is still used by " + users.text(0, 0) +
                      ", which is in the Trash. Erase the layer there first.");
    if (users.rows() > 0)
      return fail(ErrorCode::conflict, "Table in use",
                  "This table is still used by " + users.text(0, 0) +
                      ". Delete that layer or column first.");
    STRATA_TRY(drop_rows_table(connection, id));
    // Columns of the table may have the table itself as their target.
    auto columns =
        connection.query("DELETE FROM record_columns WHERE table_id = $1", Params().id(id));
    if (!columns) return tl::unexpected(columns.error());
    auto table = connection.query("DELETE FROM record_tables WHERE id = $1", Params().id(id));
    return table ? Result<void>{} : tl::unexpected(table.error());
  });
  // Runs after the transaction, because a transaction that attaches files locks a blob while it
  // waits for the tables. If it fails, the next start of the server repeats it.
  if (gone)
    (void)pool_.write_within(kBulkLimits,
                             [](PgConnection& connection) { return drop_all_unused(connection); });
  return gone;
}

Result<std::vector<Layer>> Layers::of_table(TableId table_id, Role seen_by) {
  auto refs = STRATA_TRY(pool_.read([&](PgConnection& connection) {
    return connection.query(
        "SELECT model_id, id FROM layers WHERE table_id = $1 ORDER BY model_id, draw_order, id",
        Params().id(table_id));
  }));
  std::vector<Layer> layers;
  for (int i = 0; i < refs.rows(); ++i) {
    auto found = find(refs.id<ModelId>(i, 0), std::to_string(refs.integer(i, 1)), seen_by);
    if (!found && found.error().code == ErrorCode::not_found)
      continue;  // the layer was deleted after the list was read, or is not visible
    if (!found) return tl::unexpected(found.error());
    layers.push_back(std::move(*found));
  }
  return layers;
}

Result<TableChange> Tables::create_column(TableId table_id, const Column& column,
                                          const std::string& user,
                                          const IdempotentResponse<TableChange>& answer) {
  STRATA_TRY(check_text(user, "user"));
  const auto work = [&](PgConnection& connection) -> Result<TableChange> {
    auto open = STRATA_TRY(lock_table(connection, table_id));
    Column fresh = column;
    STRATA_TRY(fit_column(connection, open, fresh));
    auto made = STRATA_TRY(insert_column(connection, open, std::move(fresh)));
    open.all.push_back(made);
    TableEdit edit{user, "create-column", {{"column", made.id}}, {}, {}};
    edit.columns[made.id] = {{"hidden", false}};
    if (!made.default_value.is_null()) {
      auto rows = STRATA_TRY(load_all_rows(connection, table_id, {}));
      for (const Record& row : rows) edit.records[row.key][to_string(made.id)] = made.default_value;
    }
    return refused_by_records(apply_edit(connection, open, std::move(edit)));
  };
  return change(pool_, answer, work, kBulkLimits);
}

Result<TableChange> Tables::update_column(TableId table_id, const Column& column,
                                          std::optional<std::int64_t> version,
                                          const std::string& user,
                                          const IdempotentResponse<TableChange>& answer) {
  STRATA_TRY(check_text(user, "user"));
  const auto work = [&](PgConnection& connection) -> Result<TableChange> {
    auto open = STRATA_TRY(lock_table(connection, table_id));
    auto found = STRATA_TRY(shown_column(open, column.id, version));
    const Column old = *found;
    Column requested = column;
    STRATA_TRY(fit_column(connection, open, requested));
    if (requested.kind != old.kind || requested.target != old.target)
      return retype(connection, open, old, std::move(requested), user);
    TableEdit edit{user, "change-column", {{"column", old.id}}, {}, {}};
    const Cells now = cells_of(old);
    for (auto& [name, value] : cells_of(requested))
      if (now.at(name) != value) edit.columns[old.id][name] = value;
    if (edit.columns.empty()) {
      TableChange nothing;
      nothing.table = std::move(open.table);
      return nothing;
    }
    return refused_by_records(apply_edit(connection, open, std::move(edit)));
  };
  return change(pool_, answer, work, kBulkLimits);
}

Result<Table> Tables::show_column(TableId table_id, ColumnId column_id, Visibility visibility,
                                  std::int64_t version, const IdempotentResponse<Table>& answer) {
  return change(pool_, answer, [&](PgConnection& connection) -> Result<Table> {
    auto open = STRATA_TRY(lock_table(connection, table_id));
    auto found = STRATA_TRY(shown_column(open, column_id, version));
    Column column = *found;
    column.visibility = visibility;
    STRATA_TRY(check_column(column));
    if (const auto terms = term_columns(open.table); terms && visibility != Visibility::everyone) {
      std::set<const Column*> used{terms->code, terms->label, terms->parent, terms->definition,
                                   terms->uri,  terms->color, terms->pattern};
      for (const auto& [language, label] : terms->labels) used.insert(label);
      if (used.contains(found))
        return fail(ErrorCode::invalid, "Column of a term list",
                    "Everybody who can see a record must see its terms, so the visibility of this "
                    "column cannot change.",
                    "visibility");
    }
    STRATA_TRY(connection.query("UPDATE record_columns SET visibility = $2 WHERE id = $1",
                                Params().id(column_id).text(name(visibility))));
    STRATA_TRY(connection.query("UPDATE record_tables SET version = version + 1 WHERE id = $1",
                                Params().id(table_id)));
    return table_of(connection, table_id);
  });
}

Result<TableChange> Tables::drop_column(TableId table_id, ColumnId column_id,
                                        std::optional<std::int64_t> version,
                                        const std::string& user,
                                        const IdempotentResponse<TableChange>& answer) {
  STRATA_TRY(check_text(user, "user"));
  return change(pool_, answer, [&](PgConnection& connection) -> Result<TableChange> {
    auto open = STRATA_TRY(lock_table(connection, table_id));
    STRATA_TRY(shown_column(open, column_id, version));
    TableEdit edit{user, "drop-column", {{"column", column_id}}, {}, {}};
    edit.columns[column_id] = {{"hidden", true}};
    return apply_edit(connection, open, std::move(edit));
  });
}

Result<TableChange> Tables::change_of(TableId table_id, std::int64_t sequence,
                                      std::size_t most_records) {
  return pool_.read([&](PgConnection& connection) -> Result<TableChange> {
    auto transaction = STRATA_TRY(Transaction::begin_reading(connection));
    TableChange change;
    change.table = STRATA_TRY(table_of(connection, table_id));
    change.sequence = sequence;
    auto cells = STRATA_TRY(connection.query(
        "SELECT subject = 'column', subject_id, (after ->> 'exists')::boolean FROM table_changes "
        "WHERE table_id = $1 AND sequence = $2 ORDER BY subject_id",
        Params().id(table_id).integer(sequence)));
    if (cells.rows() == 0) return no_such("table entry", std::to_string(sequence));
    for (int i = 0; i < cells.rows(); ++i) {
      const auto id = cells.integer(i, 1);
      if (cells.boolean(i, 0))
        change.columns_changed = true;
      else if (cells.null(i, 2))
        change.changed.push_back(id);
      else
        (cells.boolean(i, 2) ? change.created : change.deleted).push_back(id);
    }
    if (!change.created.empty()) {
      const auto gone = STRATA_TRY(missing_rows(connection, table_id, change.created));
      std::erase_if(change.created,
                    [&](const std::int64_t key) { return std::ranges::binary_search(gone, key); });
    }
    if (change.columns_changed || change.created.size() + change.changed.size() > most_records)
      return change;
    std::vector<std::int64_t> keys = change.created;
    keys.insert(keys.end(), change.changed.begin(), change.changed.end());
    std::ranges::sort(keys);
    if (!keys.empty())
      change.records = STRATA_TRY(load_rows(connection, table_id, change.table.columns, keys));
    return change;
  });
}

}  // namespace strata::store
