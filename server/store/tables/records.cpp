#include <algorithm>
#include <charconv>
#include <set>

#include "domain/tables/column_value.h"
#include "store/journal/kept_states.h"
#include "store/store_impl.h"
#include "store/tables/record_sql.h"
#include "store/tables/records.h"
#include "store/tables/table_past.h"
#include "store/tables/table_rows.h"
#include "store/tables/table_writer.h"
#include "store/tables/tables.h"

namespace strata::store {
namespace {

nlohmann::json keys_json(const std::vector<std::int64_t>& keys) {
  return nlohmann::json(std::vector(
      keys.begin(),
      keys.begin() + static_cast<std::ptrdiff_t>(std::min(keys.size(), kMaxRowProblems))));
}

// Returns the value as text. Whole numbers have no fraction, even in columns that allow one.
std::string text_of(const nlohmann::json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (!value.is_number_float()) return value.dump();
  char text[40];
  const auto [end, error] = std::to_chars(text, text + sizeof text, value.get<double>());
  return error == std::errc() ? std::string(text, end) : value.dump();
}

// Converts a request to cells, record by record.
class Intake {
 public:
  Intake(PgConnection& connection, const OpenTable& open, const WriteRecords& request)
      : connection_(connection), open_(open), request_(request) {}

  Result<TableEdit> read(const std::string& user) {
    std::vector<std::int64_t> keys;
    for (const RecordInput& input : request_.records)
      if (input.key) keys.push_back(*input.key);
    auto rows = STRATA_TRY(load_rows(connection_, open_.table.id, open_.all, keys));
    for (Record& row : rows) now_[row.key] = std::move(row);
    auto gone = STRATA_TRY(used_keys(keys));
    gone_ = std::move(gone);
    named_.insert(keys.begin(), keys.end());
    next_key_ = open_.next_key;
    TableEdit edit{user, request_.op, {}, {}, {}};
    for (std::size_t i = 0; i < request_.records.size(); ++i)
      if (auto cells = cells_for(request_.records[i]); !cells)
        add_problem(i, cells.error());
      else if (!cells->second.empty())
        edit.records.insert(std::move(*cells));
    std::vector<std::int64_t> written;
    for (const auto& [key, cells] : edit.records) written.push_back(key);
    edit.record = {{"records", written.size()}, {"keys", keys_json(written)}};
    return edit;
  }

  std::vector<RowError>& problems() { return problems_; }
  std::optional<std::size_t> index_of(std::int64_t key) const {
    const auto found = index_of_.find(key);
    return found == index_of_.end() ? std::nullopt : std::optional(found->second);
  }

 private:
  // Returns the given keys that a record once had, because an undo may restore that record.
  Result<std::set<std::int64_t>> used_keys(const std::vector<std::int64_t>& keys) {
    PgArray requested(oid::kInt8);
    for (const auto key : keys) requested.add(key);
    auto rows = STRATA_TRY(connection_.query(
        "SELECT DISTINCT subject_id FROM table_changes WHERE table_id = $1 AND subject = 'record' AND subject_id = any($2)",
        Params().id(open_.table.id).array(requested)));
    std::set<std::int64_t> used;
    for (int i = 0; i < rows.rows(); ++i)
      if (!now_.contains(rows.integer(i, 0))) used.insert(rows.integer(i, 0));
    return used;
  }

  // Returns the cells that change; for a new record, also the defaults.
  Result<std::pair<std::int64_t, Cells>> cells_for(const RecordInput& input) {
    const std::size_t index = next_index_++;
    if (input.key && (*input.key < 0 || *input.key > kMaxRecordKey))
      return fail(ErrorCode::invalid, "Invalid key",
                  "A key must be a whole number from 0 to 4294967295.", "key");
    const auto now = input.key ? now_.find(*input.key) : now_.end();
    const bool exists = now != now_.end();
    if (exists ? !request_.may_change : !request_.may_create)
      return exists ? fail(ErrorCode::conflict, "Record already exists",
                           "Record " + std::to_string(*input.key) + " already exists.", "key")
                    : Result<std::pair<std::int64_t, Cells>>(
                          no_such("record", std::to_string(input.key.value_or(0))));
    if (exists && input.version && *input.version != now->second.version) return stale("record");
    if (!exists && input.key && gone_.contains(*input.key))
      return fail(
          ErrorCode::conflict, "Key already used",
          "Key " + std::to_string(*input.key) +
              " belonged to a record that was deleted. The server does not reuse keys. Choose "
              "another key.",
          "key");
    while (!input.key && named_.contains(next_key_)) ++next_key_;
    if (!input.key && next_key_ > kMaxRecordKey)
      return fail(ErrorCode::conflict, "No keys left", "All keys up to 4294967295 are used.",
                  "key");
    const std::int64_t key = input.key ? *input.key : next_key_++;
    if (!index_of_.emplace(key, index).second)
      return fail(ErrorCode::invalid, "Duplicate record",
                  "Record " + std::to_string(key) + " appears twice. Send it once.", "key");
    Cells cells;
    if (!exists) cells["exists"] = true;
    for (const auto& [id, value] : input.values)
      if (std::none_of(open_.table.columns.begin(), open_.table.columns.end(),
                       [id = id](const Column& column) { return column.id == id; }))
        return no_such("column", to_string(id));
    for (const Column& column : open_.table.columns) {
      const auto given = input.values.find(column.id);
      if (given == input.values.end() && exists) continue;
      auto value =
          check_value(column, given == input.values.end() ? column.default_value : given->second,
                      "values." + column.slug);
      if (!value) return tl::unexpected(value.error());
      nlohmann::json held;
      if (exists)
        if (const auto cell = now->second.values.find(column.id); cell != now->second.values.end())
          held = cell->second;
      if (*value != held) cells[to_string(column.id)] = std::move(*value);
    }
    return std::pair(key, std::move(cells));
  }

  void add_problem(std::size_t index, const Error& problem) {
    if (problems_.size() < kMaxRowProblems)
      problems_.push_back({request_.records[index].key.value_or(0), problem, index});
  }

  PgConnection& connection_;
  const OpenTable& open_;
  const WriteRecords& request_;
  std::map<std::int64_t, Record> now_;
  std::set<std::int64_t> gone_, named_;
  std::map<std::int64_t, std::size_t> index_of_;
  std::int64_t next_key_ = 1;
  std::size_t next_index_ = 0;
  std::vector<RowError> problems_;
};

Result<TableChange> write_all(PgConnection& connection, TableId table_id,
                              const WriteRecords& request, const std::string& user) {
  auto open = STRATA_TRY(lock_table(connection, table_id));
  Intake intake(connection, open, request);
  auto edit = STRATA_TRY(intake.read(user));
  TableChange change;
  change.table = open.table;
  change.problems = std::move(intake.problems());
  // Without a change, the journal gets no entry.
  if (!change.problems.empty() || edit.records.empty()) return change;
  auto done = STRATA_TRY(apply_edit(connection, open, std::move(edit)));
  for (RowError& problem : done.problems) problem.index = intake.index_of(problem.key);
  return done;
}

// Returns the rows after a sequence, and sets `open` to that state. Returns nothing if it is the
// current state, and an error for a sequence in the future.
Result<std::optional<std::vector<Record>>> rows_if_past(PgConnection& connection, OpenTable& open,
                                                        std::optional<std::int64_t> at) {
  if (at && *at > open.table.sequence)
    return fail(ErrorCode::invalid, "Sequence out of range",
                "The newest sequence of this table is " + std::to_string(open.table.sequence) + ".",
                "at");
  if (!at || *at == open.table.sequence) return std::optional<std::vector<Record>>();
  auto rows = STRATA_TRY(rows_at(connection, open, *at));
  return std::optional(std::move(rows));
}

// `undone_by` is stored with the entry that is undone. Empty: the entry is redone.
Result<TableChange> apply_undo(PgConnection& connection, OpenTable& open, PlannedUndo undo,
                               std::optional<std::int64_t> undone_by) {
  auto change = STRATA_TRY(apply_edit(connection, open, std::move(undo.edit)));
  if (!change.problems.empty()) {
    Error problem = change.problems.front().problem;
    return fail(ErrorCode::conflict, undone_by ? "Cannot undo" : "Cannot redo", problem.detail,
                problem.field);
  }
  STRATA_TRY(connection.query(
      "UPDATE table_edits SET in_force = $3, undone_by = $4 WHERE table_id = $1 AND sequence = $2",
      Params()
          .id(open.table.id)
          .integer(undo.plan.edit)
          .boolean(!undone_by)
          .optional_integer(undone_by)));
  return change;
}

// Returns a `conflict` error if a later entry changes a record of this entry.
Result<void> check_unchanged_since(PgConnection& connection, TableId table_id,
                                   std::int64_t sequence) {
  const auto later = STRATA_TRY(connection.query(
      "SELECT c.subject_id FROM table_changes e JOIN table_changes c ON c.table_id = e.table_id AND c.subject = e.subject "
      "AND c.subject_id = e.subject_id AND c.sequence > e.sequence "
      "WHERE e.table_id = $1 AND e.sequence = $2 AND e.subject = 'record' ORDER BY c.subject_id LIMIT 1",
      Params().id(table_id).integer(sequence)));
  if (later.rows() == 0) return {};
  return fail(ErrorCode::conflict, "Record was changed",
              "Record " + std::to_string(later.integer(0, 0)) +
                  " has been changed since. Read the records again.");
}

}  // namespace

Result<TableChange> Records::write(TableId table_id, const WriteRecords& request,
                                   const std::string& user,
                                   const IdempotentResponse<TableChange>& answer) {
  STRATA_TRY(check_text(user, "user"));
  if (request.records.size() > kMaxRecordsAtOnce)
    return fail(ErrorCode::too_large, "Too many records",
                "At most " + std::to_string(kMaxRecordsAtOnce) +
                    " records are allowed in one request. Send them in several requests.");
  // A dry run, or a change with problems, is rolled back, but its outcome is returned.
  std::optional<TableChange> outcome;
  auto done = change(
      pool_, answer,
      [&](PgConnection& connection) -> Result<TableChange> {
        auto change = write_all(connection, table_id, request, user);
        if (!change || (change->problems.empty() && !request.dry_run)) return change;
        outcome = std::move(*change);
        return fail(ErrorCode::conflict, "Not saved", "Nothing was written.");
      },
      kBulkLimits);
  if (outcome) return std::move(*outcome);
  return done;
}

Result<TableChange> Records::remove(TableId table_id, std::int64_t key,
                                    std::optional<std::int64_t> version, const std::string& user,
                                    bool dry_run, const IdempotentResponse<TableChange>& answer) {
  STRATA_TRY(check_text(user, "user"));
  std::optional<TableChange> outcome;
  auto done = change(pool_, answer, [&](PgConnection& connection) -> Result<TableChange> {
    auto open = STRATA_TRY(lock_table(connection, table_id));
    auto rows = STRATA_TRY(load_rows(connection, table_id, open.all, std::vector{key}));
    if (rows.empty()) return no_such("record", std::to_string(key));
    if (version && *version != rows.front().version) return stale("record");
    TableEdit edit{
        user, "delete", {{"records", 1}, {"keys", nlohmann::json::array({key})}}, {}, {}};
    Cells& cells = edit.records[key];
    cells["exists"] = false;
    for (const Column& column : open.all) cells[to_string(column.id)] = nullptr;
    auto change = apply_edit(connection, open, std::move(edit));
    if (change && !change->problems.empty())
      return tl::unexpected(change->problems.front().problem);
    if (!change || !dry_run) return change;
    outcome = std::move(*change);
    return fail(ErrorCode::conflict, "Not saved", "Nothing was written.");
  });
  if (outcome) return std::move(*outcome);
  return done;
}

Result<std::vector<KeyNumber>> Records::numbers(TableId table_id, Role seen_by,
                                                const Expression& expression,
                                                std::optional<std::int64_t> at,
                                                const std::string& field) {
  return pool_.read([&](PgConnection& connection) -> Result<std::vector<KeyNumber>> {
    auto transaction = STRATA_TRY(Transaction::begin_reading(connection));
    auto open = STRATA_TRY(read_table(connection, table_id, seen_by));
    auto past = STRATA_TRY(rows_if_past(connection, open, at));
    Params params;
    auto sql = STRATA_TRY(expression.is_condition()
                              ? condition_sql(expression, open, connection, params, field)
                              : number_sql(expression, open, connection, params, field));
    auto numbers =
        load_numbers(connection, table_id, open.table.columns, past,
                     expression.is_condition() ? "(" + sql + ")::integer" : sql, std::move(params));
    if (!numbers) return tl::unexpected(unanswerable(connection, numbers.error(), field));
    STRATA_TRY(transaction.commit());
    return numbers;
  });
}

Result<std::vector<KeyText>> Records::texts(TableId table_id, Role seen_by, const std::string& ref,
                                            const std::string& field) {
  return pool_.read([&](PgConnection& connection) -> Result<std::vector<KeyText>> {
    auto open = STRATA_TRY(read_table(connection, table_id, seen_by));
    const Column* column = find_column(open.table.columns, ref);
    if (!column)
      return fail(ErrorCode::invalid, "Column not found",
                  "The table '" + open.table.name + "' has no column '" + ref + "'.", field);
    if (holds_lists(column->kind))
      return fail(ErrorCode::invalid, "Column contains lists",
                  "'" + column->name +
                      "' can contain several values in one record. Choose a column with only one "
                      "value in each record.",
                  field);
    auto rows = STRATA_TRY(load_all_rows(connection, table_id, {*column}));
    std::vector<KeyText> texts;
    for (const Record& row : rows) {
      const auto cell = row.values.find(column->id);
      if (cell == row.values.end() || cell->second.is_null()) continue;
      texts.push_back({static_cast<std::uint32_t>(row.key), text_of(cell->second)});
    }
    return texts;
  });
}

Result<std::vector<KeyFeature>> Records::features(TableId table_id, Role seen_by, ModelId model_id,
                                                  std::optional<std::int64_t> at) {
  return pool_.read([&](PgConnection& connection) -> Result<std::vector<KeyFeature>> {
    auto transaction = STRATA_TRY(Transaction::begin_reading(connection));
    auto open = STRATA_TRY(read_table(connection, table_id, seen_by));
    auto past = STRATA_TRY(rows_if_past(connection, open, at));
    std::vector<Column> columns;
    for (const Column& column : open.table.columns)
      if (holds_features(column.kind)) columns.push_back(column);
    std::vector<KeyFeature> found;
    if (columns.empty()) return found;
    auto rows = STRATA_TRY(past ? Result<std::vector<Record>>(std::move(*past))
                                : load_all_rows(connection, table_id, columns));
    for (const Record& row : rows)
      for (const Column& column : columns)
        for (SurfaceFeature& feature : features_of(row, column))
          if (feature.model == model_id) found.push_back({row.key, std::move(feature)});
    std::ranges::stable_sort(found, {}, &KeyFeature::key);
    STRATA_TRY(transaction.commit());
    return found;
  });
}

Result<RecordPage> Records::page(TableId table_id, Role seen_by, const RecordQuery& query) {
  return pool_.read([&](PgConnection& connection) -> Result<RecordPage> {
    auto transaction = STRATA_TRY(Transaction::begin_reading(connection));
    auto open = STRATA_TRY(read_table(connection, table_id, seen_by));
    RecordPage page;
    auto past = STRATA_TRY(rows_if_past(connection, open, query.at));
    page.table = open.table;
    std::vector<RecordOrder> order;
    auto collation =
        query.order.empty() ? Result<std::string>() : collation_of(connection, query.language);
    if (!collation) return tl::unexpected(collation.error());
    for (const auto& [ref, descending] : query.order) {
      if (ref == "key") {
        order.push_back({0, descending});
        continue;
      }
      const Column* column = find_column(open.table.columns, ref);
      if (!column)
        return fail(ErrorCode::invalid, "Column not found",
                    "The table has no column `" + ref.substr(0, 100) + "`.", "sortby");
      order.push_back({column->id, descending, *collation});
      if (column->kind != ColumnKind::term) continue;
      auto keys = keys_in_order(connection, *column->target, seen_by, *collation);
      if (!keys) return tl::unexpected(keys.error());
      order.back().keys = std::move(*keys);
    }
    if (query.keys) {
      if (past) {
        std::erase_if(*past, [&](const Record& row) {
          return std::find(query.keys->begin(), query.keys->end(), row.key) == query.keys->end();
        });
        page.records = std::move(*past);
      } else {
        auto rows = STRATA_TRY(load_rows(connection, table_id, open.table.columns, *query.keys));
        page.records = std::move(rows);
      }
      page.total = static_cast<std::int64_t>(page.records.size());
    } else {
      Params params;
      std::string where;
      if (query.filter) {
        auto sql = STRATA_TRY(condition_sql(*query.filter, open, connection, params, "filter"));
        where = std::move(sql);
      }
      auto rows = load_page(connection, table_id, open.table.columns, past, where,
                            std::move(params), order, {query.limit, query.offset, query.after});
      if (!rows && rows.error().field == "after") return tl::unexpected(rows.error());
      if (!rows) return tl::unexpected(unanswerable(connection, rows.error(), "filter"));
      page.records = std::move(rows->rows);
      page.total = rows->total;
      page.last = std::move(rows->last);
    }
    STRATA_TRY(transaction.commit());
    return page;
  });
}

Result<std::vector<std::int64_t>> Records::missing(TableId table_id,
                                                   std::span<const std::int64_t> keys) {
  return pool_.read(
      [&](PgConnection& connection) { return missing_rows(connection, table_id, keys); });
}

Result<std::int64_t> Tables::sequence_at(TableId table_id, const std::string& utc) {
  return pool_.read([&](PgConnection& connection) -> Result<std::int64_t> {
    // As for models, the state at the time of an edit, in milliseconds, must include the edit.
    auto row = STRATA_TRY(connection.query(
        "SELECT coalesce(max(sequence), 0) FROM table_edits "
        "WHERE table_id = $1 AND date_trunc('milliseconds', time) <= $2::timestamptz",
        Params().id(table_id).text(utc)));
    return row.integer(0, 0);
  });
}

Result<std::int64_t> Tables::sequence_when(TableId table_id, ModelId model_id,
                                           std::int64_t sequence) {
  return pool_.read([&](PgConnection& connection) -> Result<std::int64_t> {
    auto transaction = STRATA_TRY(Transaction::begin_reading(connection));
    // Inside a checkpoint of any layer, the journal no longer has the time of the state.
    STRATA_TRY(check_kept(connection, model_id, sequence));
    auto row = STRATA_TRY(connection.query(
        "SELECT coalesce(max(sequence), 0) FROM table_edits WHERE table_id = $1 AND "
        "time <= (SELECT max(time) FROM edits WHERE model_id = $2 AND sequence <= $3)",
        Params().id(table_id).id(model_id).integer(sequence)));
    return row.integer(0, 0);
  });
}

Result<TableHistory> Tables::history(TableId table_id, Role seen_by,
                                     std::optional<std::int64_t> key, int limit, int offset,
                                     std::optional<std::int64_t> before) {
  return pool_.read([&](PgConnection& connection) {
    return read_history(connection, table_id, seen_by, key, limit, offset, before);
  });
}

Result<UndoPlan> Tables::plan_undo(TableId table_id, const std::string& user, bool redo) {
  STRATA_TRY(check_text(user, "user"));
  return pool_.read([&](PgConnection& connection) -> Result<UndoPlan> {
    auto open = STRATA_TRY(read_table(connection, table_id));
    auto undo = STRATA_TRY(store::plan_undo(connection, open, user, redo));
    return std::move(undo.plan);
  });
}

Result<TableChange> Tables::undo(TableId table_id, const std::string& user, bool redo,
                                 std::int64_t planned_at,
                                 const IdempotentResponse<TableChange>& answer) {
  const auto work = [&](PgConnection& connection) -> Result<TableChange> {
    auto open = STRATA_TRY(lock_table(connection, table_id));
    if (open.table.sequence != planned_at) return stale("table");
    auto undo = STRATA_TRY(store::plan_undo(connection, open, user, redo));
    return apply_undo(connection, open, std::move(undo),
                      redo ? std::nullopt : std::optional(open.table.sequence + 1));
  };
  return change(pool_, answer, work, kBulkLimits);
}

Result<TableChange> Tables::undo_entry(TableId table_id, std::int64_t sequence,
                                       const std::string& user) {
  STRATA_TRY(check_text(user, "user"));
  const auto work = [&](PgConnection& connection) -> Result<TableChange> {
    auto open = STRATA_TRY(lock_table(connection, table_id));
    STRATA_TRY(check_unchanged_since(connection, table_id, sequence));
    auto undo = STRATA_TRY(store::plan_undo(connection, open, user, false, sequence));
    // An entry that undid itself is not redone (`edit_to_flip`).
    return apply_undo(connection, open, std::move(undo), sequence);
  };
  IdempotentResponse<TableChange> answer;
  answer.user = user;
  return change(pool_, answer, work, kBulkLimits);
}

}  // namespace strata::store
