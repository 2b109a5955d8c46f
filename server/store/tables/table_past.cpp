#include "store/tables/table_past.h"

#include <algorithm>

#include "domain/tables/cell_history.h"
#include "store/pg/pg_row.h"
#include "store/store_impl.h"
#include "store/tables/table_rows.h"

namespace strata::store {
namespace {

Cells cells_from(const nlohmann::json& json) { return json.get<Cells>(); }

// Returns the entry that an undo or redo would change. For an undo, it is the newest entry of the
// user in force, or `entry`, if it is one of these. For a redo, it is the entry that the newest
// undo disabled, unless a change that the user made after that undo is in force (as for layers,
// store/journal/edits.cpp). Entries of Tables::undo_entry, whose `undone_by` is their own sequence,
// are never redone.
Result<std::optional<std::int64_t>> edit_to_flip(PgConnection& connection, TableId table_id,
                                                 const std::string& user, bool redo,
                                                 std::optional<std::int64_t> entry) {
  Params params;
  params.id(table_id).text(user);
  if (!redo) params.optional_integer(entry);
  auto row = STRATA_TRY(connection.query(
      redo
          ? "SELECT e.sequence FROM table_edits e WHERE e.table_id = $1 AND e.user_name = $2 AND e.writer AND NOT e.in_force "
            "AND e.undone_by > e.sequence AND NOT EXISTS (SELECT 1 FROM table_edits n WHERE n.table_id = $1 AND n.user_name = $2 AND n.writer AND n.in_force "
            "AND n.sequence > e.undone_by) ORDER BY e.undone_by DESC LIMIT 1"
          : "SELECT sequence FROM table_edits WHERE table_id = $1 AND user_name = $2 AND writer AND in_force "
            "AND ($3::bigint IS NULL OR sequence = $3) ORDER BY sequence DESC LIMIT 1",
      params));
  if (row.rows() == 0) return std::optional<std::int64_t>();
  return std::optional(row.integer(0, 0));
}

// Returns the values of the given cells as if the edit `flipped` were enabled or disabled. Cells
// belong to records, by key, or to columns, by id.
template <class Subject>
Result<std::map<Subject, Cells>> resolve(PgConnection& connection, TableId table_id,
                                         const char* subject,
                                         const std::map<Subject, std::set<std::string>>& names,
                                         std::int64_t flipped, bool in_force) {
  std::map<Subject, CellResolver> resolvers;
  PgArray ids(oid::kInt8);
  for (const auto& [id, columns] : names) {
    ids.add(id);
    resolvers.emplace(id, CellResolver(columns));
  }
  STRATA_TRY(connection.each_row(
      "SELECT c.subject_id, c.sequence, e.writer, e.in_force, c.before, c.after FROM table_changes c "
      "JOIN table_edits e ON e.table_id = c.table_id AND e.sequence = c.sequence "
      "WHERE c.table_id = $1 AND c.subject = $2 AND c.subject_id = any($3) ORDER BY c.subject_id, c.sequence DESC",
      Params().id(table_id).text(subject).array(ids), [&](const PgResult& row) -> Result<void> {
        CellResolver& resolver = resolvers.at(Subject(row.integer(0, 0)));
        if (!resolver.is_open()) return {};
        const std::int64_t sequence = row.integer(0, 1);
        resolver.add({sequence, row.boolean(0, 2),
                      sequence == flipped ? in_force : row.boolean(0, 3),
                      cells_from(row.json(0, 4)), cells_from(row.json(0, 5))});
        return {};
      }));
  std::map<Subject, Cells> resolved;
  for (auto& [id, resolver] : resolvers) resolved[id] = std::move(resolver).finish();
  return resolved;
}

Result<std::set<ColumnId>> unseen_columns(PgConnection& connection, TableId table_id, Role role) {
  auto open = STRATA_TRY(read_table(connection, table_id));
  std::set<ColumnId> unseen;
  for (const Column& column : open.all)
    if (!sees(role, column.visibility)) unseen.insert(column.id);
  return unseen;
}

void leave_out(TableEditRow& row, const std::set<ColumnId>& columns) {
  if (columns.empty()) return;
  const auto names = [&](const char* member) {
    const auto named = row.record.find(member);
    return named != row.record.end() && named->is_number_integer() &&
           columns.contains(named->get<ColumnId>());
  };
  if (row.record.is_object() && (names("column") || names("from")))
    row.record = nlohmann::json::object();
  for (TableEditRow::Change& change : row.changes) {
    if (change.is_column) continue;
    for (const ColumnId column : columns) {
      change.before.erase(to_string(column));
      change.after.erase(to_string(column));
    }
  }
  const auto gone = std::erase_if(row.changes, [&](const TableEditRow::Change& change) {
    return change.is_column ? columns.contains(ColumnId(change.id))
                            : change.before.empty() && change.after.empty();
  });
  row.total_changes -= static_cast<std::int64_t>(gone);
}

}  // namespace

Result<std::vector<Record>> rows_at(PgConnection& connection, OpenTable& open,
                                    std::int64_t sequence) {
  auto rows = STRATA_TRY(load_all_rows(connection, open.table.id, open.all));
  std::map<std::int64_t, Record> then;
  std::map<std::int64_t, bool> touched;  // by key; true if the record existed then
  for (Record& row : rows) then[row.key] = std::move(row);
  std::map<ColumnId, Cells> columns;
  STRATA_TRY(connection.each_row(
      "SELECT subject = 'column', subject_id, before FROM table_changes WHERE table_id = $1 AND sequence > $2 "
      "ORDER BY sequence DESC",
      Params().id(open.table.id).integer(sequence), [&](const PgResult& row) -> Result<void> {
        const std::int64_t id = row.integer(0, 1);
        const Cells before = cells_from(row.json(0, 2));
        if (row.boolean(0, 0)) {
          for (const auto& [name, value] : before) columns[ColumnId(id)][name] = value;
          return {};
        }
        Record& record = then[id];
        record.key = id;
        touched.try_emplace(id, true);
        for (const auto& [name, value] : before)
          if (name == "exists")
            touched[id] = value == true;
          else if (value.is_null())
            record.values.erase(ColumnId(std::int64_t{std::stoll(name)}));
          else
            record.values[ColumnId(std::int64_t{std::stoll(name)})] = value;
        return {};
      }));
  PgArray keys(oid::kInt8);
  for (const auto& [key, existed] : touched) {
    if (!existed) then.erase(key);
    keys.add(key);
  }
  auto versions = STRATA_TRY(connection.query(
      "SELECT subject_id, max(sequence) FROM table_changes WHERE table_id = $1 AND subject = 'record' AND sequence <= $2 "
      "AND subject_id = any($3) GROUP BY subject_id",
      Params().id(open.table.id).integer(sequence).array(keys)));
  for (const auto& [key, existed] : touched)
    if (existed) then[key].version = 0;
  for (int i = 0; i < versions.rows(); ++i)
    if (const auto found = then.find(versions.integer(i, 0)); found != then.end())
      found->second.version = versions.integer(i, 1);
  put_cells(open, columns);
  open.table.sequence = sequence;
  open.table.records = static_cast<std::int64_t>(then.size());
  std::vector<Record> past;
  for (auto& [key, record] : then) past.push_back(std::move(record));
  return past;
}

Result<TableHistory> read_history(PgConnection& connection, TableId table_id, Role seen_by,
                                  std::optional<std::int64_t> key, int limit, int offset,
                                  std::optional<std::int64_t> before) {
  auto total = STRATA_TRY(connection.query(
      "SELECT count(*) FROM table_edits e WHERE table_id = $1 AND ($2::bigint IS NULL OR EXISTS (SELECT 1 FROM table_changes c "
      "WHERE c.table_id = $1 AND c.subject = 'record' AND c.subject_id = $2 AND c.sequence = e.sequence))",
      Params().id(table_id).optional_integer(key)));
  auto rows = STRATA_TRY(connection.query(
      "SELECT sequence, user_name, op, record, time, in_force, (SELECT count(*) FROM table_changes c WHERE c.table_id = $1 "
      "AND c.sequence = e.sequence AND ($2::bigint IS NULL OR (c.subject = 'record' AND c.subject_id = $2))) "
      "FROM table_edits e WHERE table_id = $1 AND ($2::bigint IS NULL OR EXISTS (SELECT 1 FROM table_changes c "
      "WHERE c.table_id = $1 AND c.subject = 'record' AND c.subject_id = $2 AND c.sequence = e.sequence)) "
      "AND sequence < $5 ORDER BY sequence DESC LIMIT $3 OFFSET $4",
      Params().id(table_id).optional_integer(key).integer(limit).integer(offset).integer(
          before.value_or(INT64_MAX))));
  auto unseen = STRATA_TRY(unseen_columns(connection, table_id, seen_by));
  TableHistory history;
  history.total = total.integer(0, 0);
  for (int i = 0; i < rows.rows(); ++i) {
    PgRow columns(rows, i);
    TableEditRow row{columns.integer(),
                     columns.text(),
                     columns.text(),
                     columns.json(),
                     columns.time(),
                     columns.boolean(),
                     {},
                     columns.integer()};
    auto changes = STRATA_TRY(connection.query(
        "SELECT subject = 'column', subject_id, before, after FROM table_changes WHERE table_id = $1 AND sequence = $2 "
        "AND ($3::bigint IS NULL OR (subject = 'record' AND subject_id = $3)) ORDER BY subject, subject_id LIMIT $4",
        Params()
            .id(table_id)
            .integer(row.sequence)
            .optional_integer(key)
            .integer(kMaxListedChanges)));
    for (int c = 0; c < changes.rows(); ++c)
      row.changes.push_back({changes.boolean(c, 0), changes.integer(c, 1),
                             cells_from(changes.json(c, 2)), cells_from(changes.json(c, 3))});
    leave_out(row, unseen);
    history.rows.push_back(std::move(row));
  }
  return history;
}

Result<PlannedUndo> plan_undo(PgConnection& connection, const OpenTable& open,
                              const std::string& user, bool redo,
                              std::optional<std::int64_t> entry) {
  auto edit = STRATA_TRY(edit_to_flip(connection, open.table.id, user, redo, entry));
  if (!edit)
    return redo
               ? fail(ErrorCode::conflict, "Nothing to redo",
                      "You have no undone change in this table, or you have changed it since then.")
               : fail(ErrorCode::conflict, "Nothing to undo",
                      "You have no change in this table to undo.");
  std::map<std::int64_t, std::set<std::string>> records;
  std::map<ColumnId, std::set<std::string>> columns;
  auto written = STRATA_TRY(connection.query(
      "SELECT subject = 'column', subject_id, after FROM table_changes WHERE table_id = $1 AND sequence = $2",
      Params().id(open.table.id).integer(*edit)));
  for (int i = 0; i < written.rows(); ++i) {
    auto& names = written.boolean(i, 0) ? columns[written.id<ColumnId>(i, 1)]
                                        : records[written.integer(i, 1)];
    const Cells after = cells_from(written.json(i, 2));
    for (const auto& [name, value] : after) names.insert(name);
    // A record appears or disappears with all its values, also with values that other users wrote.
    if (after.contains("exists"))
      for (const Column& column : open.all) names.insert(to_string(column.id));
  }
  PlannedUndo planned;
  planned.plan.table_sequence = open.table.sequence;
  planned.plan.edit = *edit;
  planned.edit = {user, redo ? "redo" : "undo", {{"edit", *edit}}, {}, {}, true};
  if (!records.empty()) {
    auto resolved = STRATA_TRY(resolve(connection, open.table.id, "record", records, *edit, redo));
    planned.edit.records = std::move(resolved);
  }
  if (!columns.empty()) {
    auto resolved = STRATA_TRY(resolve(connection, open.table.id, "column", columns, *edit, redo));
    planned.edit.columns = std::move(resolved);
  }
  std::vector<std::int64_t> keys;
  for (auto& [key, cells] : planned.edit.records) keys.push_back(key);
  auto rows = STRATA_TRY(load_rows(connection, open.table.id, open.all, keys));
  std::map<std::int64_t, const Record*> now;
  for (const Record& row : rows) now[row.key] = &row;
  for (auto next = planned.edit.records.begin(); next != planned.edit.records.end();) {
    auto& [key, cells] = *next;
    const bool existed = now.contains(key);
    const auto exists = cells.find("exists");
    const bool will = exists == cells.end() ? existed : exists->second == true;
    if (existed && !will) planned.plan.vanishing.push_back(key);
    if (!will) {
      // If the deletion by another user stays in force, the values stay empty.
      for (auto& [name, value] : cells)
        if (name != "exists") value = nullptr;
      if (!existed && exists == cells.end()) {
        next = planned.edit.records.erase(next);
        continue;
      }
    }
    ++next;
  }
  return planned;
}

}  // namespace strata::store
