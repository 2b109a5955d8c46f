#include "store/tables/table_rows.h"

#include <algorithm>
#include <functional>

#include "core/text/edtf.h"
#include "domain/tables/column_value.h"
#include "domain/tables/term_list.h"
#include "store/tables/list_place.h"
#include "store/tables/table_changes.h"
#include "store/tables/table_writer.h"

namespace strata::store {
namespace {

constexpr std::size_t kRowsAtOnce = 2000;  // per INSERT: at most some MB of JSON for usual rows

std::string table_name(TableId table_id) { return "records.t" + to_string(table_id); }
std::string column_name(const Column& column) { return "c" + to_string(column.id); }
std::string index_name(TableId table_id, const Column& column) {
  return "t" + to_string(table_id) + "_" + column_name(column) + "_unique";
}

const char* sql_type(ColumnKind kind) {
  switch (kind) {
    case ColumnKind::integer:
    case ColumnKind::term: return "bigint";
    case ColumnKind::numeric: return "double precision";
    case ColumnKind::boolean: return "boolean";
    case ColumnKind::date: return "date";
    case ColumnKind::timestamp: return "timestamptz";
    case ColumnKind::relation:
    case ColumnKind::picture:
    case ColumnKind::document: return "bigint[]";
    case ColumnKind::line:
    case ColumnKind::point: return "jsonb";
    default: return "text";
  }
}

// Converts a value that PostgreSQL has printed to the form of the column's kind. PostgreSQL prints
// times in another format, and whole numbers without a decimal point.
nlohmann::json value_of(const Column& column, const nlohmann::json& stored) {
  if (stored.is_null()) return stored;
  if (column.kind == ColumnKind::numeric) return stored.get<double>();
  if (column.kind != ColumnKind::timestamp) return stored;
  Column bare;
  bare.kind = column.kind;
  return check_value(bare, stored, "").value_or(stored);
}

std::vector<Record> read_rows(const PgResult& rows, const std::vector<Column>& columns) {
  std::vector<Record> records;
  records.reserve(static_cast<std::size_t>(rows.rows()));
  for (int i = 0; i < rows.rows(); ++i) {
    Record record{rows.integer(i, 0), rows.integer(i, 1), {}};
    const nlohmann::json stored = rows.json(i, 2);
    for (const Column& column : columns)
      if (const auto found = stored.find(column_name(column));
          found != stored.end() && !found->is_null())
        record.values[column.id] = value_of(column, *found);
    records.push_back(std::move(record));
  }
  return records;
}

// Returns the rows as JSON for jsonb_populate_recordset.
nlohmann::json rows_json(const std::vector<Column>& columns, std::span<const Record> rows) {
  nlohmann::json list = nlohmann::json::array();
  for (const Record& row : rows) {
    nlohmann::json json{{"key", row.key}, {"version", row.version}};
    for (const Column& column : columns) {
      const auto found = row.values.find(column.id);
      if (found == row.values.end() || found->second.is_null()) continue;
      json[column_name(column)] = found->second;
      if (column.kind != ColumnKind::period) continue;
      const auto period = parse_edtf(found->second.get_ref<const std::string&>());
      if (period && period->first_day) json[column_name(column) + "_first"] = *period->first_day;
      if (period && period->last_day) json[column_name(column) + "_last"] = *period->last_day;
    }
    list.push_back(std::move(json));
  }
  return list;
}

PgArray array_of(std::span<const std::int64_t> keys) {
  PgArray array(oid::kInt8);
  for (const auto key : keys) array.add(key);
  return array;
}

// One sort criterion as SQL. It applies to a row `t`, and to a value that the position of a page
// contains as text.
struct SortKey {
  std::string value;  // the stored value
  std::string here;   // the compared value of a row
  // the compared value of a stored value
  std::function<std::string(const std::string& parameter)> there;
  bool descending = false;
};
struct SortKeys {
  std::vector<SortKey> keys;  // the last key is unique
  std::string joins;          // SQL after FROM
};

// The number of characters by which texts are compared, so that the position of a page is short
// enough for a URL.
constexpr int kSortedCharacters = 120;

SortKey plain_key(const std::string& value, const std::string& type, bool descending) {
  return {value, value, [type](const std::string& parameter) { return parameter + "::" + type; },
          descending};
}

SortKey text_key(const std::string& column, const std::string& before, const std::string& behind,
                 bool descending) {
  const std::string value = "left(" + column + ", " + std::to_string(kSortedCharacters) + ")";
  const auto compared = [before, behind](const std::string& text) {
    return before + text + behind;
  };
  return {value, compared(value), compared, descending};
}

// Sorts by the order of the records that the terms refer to.
void add_term_key(SortKeys& sort, const std::string& column, const RecordOrder& by,
                  Params& params) {
  params.array(array_of(*by.keys));
  const std::string places = "unnest($" + std::to_string(params.count()) +
                             "::bigint[]) WITH ORDINALITY AS ",
                    alias = "p" + std::to_string(params.count());
  sort.joins +=
      " LEFT JOIN " + places + alias + " (named, place) ON " + alias + ".named = " + column;
  const auto there = [places](const std::string& parameter) {
    return "(SELECT place FROM " + places + "n (named, place) WHERE named = " + parameter +
           "::bigint)";
  };
  sort.keys.push_back({column, alias + ".place", there, by.descending});
}

SortKeys sort_keys(const std::vector<Column>& columns, std::span<const RecordOrder> order,
                   Params& params) {
  SortKeys sort;
  for (const RecordOrder& by : order) {
    if (by.column == 0) {
      sort.keys.push_back(plain_key("t.key", "bigint", by.descending));
      return sort;  // keys are unique: later criteria have no effect
    }
    const auto column = std::ranges::find(columns, by.column, &Column::id);
    if (column == columns.end()) continue;
    const std::string name = "t." + column_name(*column), type(sql_type(column->kind));
    if (by.keys) add_term_key(sort, name, by, params);
    if (column->kind == ColumnKind::period) {
      for (const char* day : {"_first", "_last"})
        sort.keys.push_back(plain_key(name + day, "bigint", by.descending));
    } else if (type == "text") {
      const bool in_language = !by.collation.empty();
      sort.keys.push_back(text_key(name, in_language ? "(" : "lower(",
                                   in_language ? " COLLATE \"" + by.collation + "\")" : ")",
                                   by.descending));
      sort.keys.push_back(text_key(name, "(", " COLLATE \"C\")", by.descending));
    } else if (holds_lists(column->kind) || type == "jsonb") {
      sort.keys.push_back(
          // an arbitrary but stable order
          text_key(name + "::text", "(", " COLLATE \"C\")", by.descending));
    } else {
      sort.keys.push_back(plain_key(name, type, by.descending));
    }
  }
  sort.keys.push_back(plain_key("t.key", "bigint", false));
  return sort;
}

std::string order_by(const std::vector<SortKey>& keys) {
  std::string sql;
  for (const SortKey& key : keys)
    sql += (sql.empty() ? " ORDER BY " : ", ") + key.here + (key.descending ? " DESC" : " ASC") +
           " NULLS LAST";
  return sql;
}

// Returns SQL for the position of a row: the values of the sort keys as texts, each once.
std::string place_of_row(const std::vector<SortKey>& keys) {
  std::string sql;
  for (std::size_t i = 0; i < keys.size(); ++i)
    if (i == 0 || keys[i].value != keys[i - 1].value)
      sql += (sql.empty() ? "" : ", ") + ("(" + keys[i].value + ")::text");
  return "to_jsonb(ARRAY[" + sql + "])";
}

// Returns the condition that a row follows a position. Compares one key after the other. Rows
// without a value follow all rows with a value.
Result<std::string> stands_behind(const std::vector<SortKey>& keys, const nlohmann::json& place,
                                  Params& params) {
  std::string sql, equal_so_far = "true";
  std::size_t next = 0;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const SortKey& key = keys[i];
    if (i == 0 || key.value != keys[i - 1].value) {
      if (!place.is_array() || next == place.size()) return wrong_place();
      const auto& value = place[next++];
      if (!value.is_string() && !value.is_null()) return wrong_place();
      if (value.is_string())
        if (auto good = check_text(value.get_ref<const std::string&>(), "after"); !good)
          return wrong_place();
      params.optional_text(value.is_null() ? std::nullopt
                                           : std::optional(value.get<std::string>()));
    }
    const std::string there = key.there("$" + std::to_string(params.count())), &here = key.here;
    sql += (sql.empty() ? "" : " OR ") + ("(" + equal_so_far) + " AND " + there +
           " IS NOT NULL AND (" + here + " IS NULL OR " + here + (key.descending ? " < " : " > ") +
           there + "))";
    equal_so_far += " AND " + here + " IS NOT DISTINCT FROM " + there;
  }
  if (next != place.size()) return wrong_place();
  return "(" + sql + ")";
}

// Returns the FROM clause for rows `t`: the rows of the table, or past rows, which become a
// parameter.
std::string from_rows(TableId table_id, const std::vector<Column>& columns,
                      const std::optional<std::vector<Record>>& past, Params& params) {
  if (!past) return " FROM " + table_name(table_id) + " t";
  params.json(rows_json(columns, *past));
  return " FROM jsonb_populate_recordset(NULL::" + table_name(table_id) + ", $" +
         std::to_string(params.count()) + ") t";
}

Result<void> run(PgConnection& connection, const std::string& sql) {
  auto done = connection.query_once(sql);
  return done ? Result<void>{} : tl::unexpected(done.error());
}

// Makes sure that a query of an analyst does not block a change to the table
// (db/migrations/000011).
Result<void> make_way(PgConnection& connection, TableId table_id) {
  return run(connection, "SELECT analysis_make_way('" + table_name(table_id) + "')");
}

}  // namespace

Result<void> make_rows_table(PgConnection& connection, TableId table_id) {
  return run(connection, "CREATE TABLE " + table_name(table_id) +
                             " (key bigint PRIMARY KEY CHECK (key BETWEEN 0 AND " +
                             std::to_string(kMaxRecordKey) + "), version bigint NOT NULL)");
}

Result<void> drop_rows_table(PgConnection& connection, TableId table_id) {
  STRATA_TRY(make_way(connection, table_id));
  // CASCADE also drops its view (db/migrations/000011)
  return run(connection, "DROP TABLE " + table_name(table_id) + " CASCADE");
}

Result<void> add_rows_column(PgConnection& connection, TableId table_id, const Column& column) {
  const std::string name = column_name(column);
  STRATA_TRY(make_way(connection, table_id));
  std::string sql =
      "ALTER TABLE " + table_name(table_id) + " ADD COLUMN " + name + " " + sql_type(column.kind);
  if (column.kind == ColumnKind::period)
    sql += ", ADD COLUMN " + name + "_first bigint, ADD COLUMN " + name + "_last bigint";
  return run(connection, sql);
}

Result<void> make_unique_index(PgConnection& connection, TableId table_id, const Column& column) {
  return run(connection, "CREATE UNIQUE INDEX IF NOT EXISTS " + index_name(table_id, column) +
                             " ON " + table_name(table_id) + " (" + column_name(column) + ")");
}

Result<void> drop_unique_index(PgConnection& connection, TableId table_id, const Column& column) {
  return run(connection, "DROP INDEX IF EXISTS records." + index_name(table_id, column));
}

Result<std::vector<Record>> load_rows(PgConnection& connection, TableId table_id,
                                      const std::vector<Column>& columns,
                                      std::span<const std::int64_t> keys) {
  auto rows =
      connection.query_once("SELECT key, version, to_jsonb(t) FROM " + table_name(table_id) +
                                " t WHERE key = any($1) ORDER BY key",
                            Params().array(array_of(keys)));
  if (!rows) return tl::unexpected(rows.error());
  return read_rows(*rows, columns);
}

Result<std::vector<Record>> load_all_rows(PgConnection& connection, TableId table_id,
                                          const std::vector<Column>& columns) {
  auto rows = STRATA_TRY(connection.query_once("SELECT key, version, to_jsonb(t) FROM " +
                                               table_name(table_id) + " t ORDER BY key"));
  return read_rows(rows, columns);
}

Result<RowsPage> load_page(PgConnection& connection, TableId table_id,
                           const std::vector<Column>& columns,
                           const std::optional<std::vector<Record>>& past, const std::string& where,
                           Params params, std::span<const RecordOrder> order,
                           const RowsPart& part) {
  const std::string from = from_rows(table_id, columns, past, params);
  std::string only = where.empty() ? "" : " WHERE (" + where + ")";
  RowsPage page;
  auto total = STRATA_TRY(connection.query_once("SELECT count(*)" + from + only, params));
  page.total = total.integer(0, 0);
  const auto [keys, joins] = sort_keys(columns, order, params);
  if (part.after) {
    auto behind = STRATA_TRY(stands_behind(keys, *part.after, params));
    only += (only.empty() ? " WHERE " : " AND ") + behind;
  }
  // one more row shows whether there is a next page
  params.integer(part.limit + 1).integer(part.offset);
  const int count = params.count();
  auto rows =
      connection.query_once("SELECT key, version, to_jsonb(t), " + place_of_row(keys) + from +
                                joins + only + order_by(keys) + " LIMIT $" +
                                std::to_string(count - 1) + " OFFSET $" + std::to_string(count),
                            params);
  // SQLSTATE class 22: a text in `after` is not a value of its column. PostgreSQL converts no other
  // unchecked text of the client here.
  if (!rows && part.after && connection.sqlstate().starts_with("22")) return wrong_place();
  if (!rows) return tl::unexpected(rows.error());
  page.rows = read_rows(*rows, columns);
  if (rows->rows() > part.limit) {
    page.rows.pop_back();
    if (part.limit > 0) page.last = rows->json(static_cast<int>(part.limit) - 1, 3);
  }
  return page;
}

Result<std::string> collation_of(PgConnection& connection, const std::string& language) {
  PgArray candidates(oid::kText);
  std::string tag = language;
  const auto is_plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-';
  };
  if (!std::ranges::all_of(tag, is_plain)) tag.clear();
  for (; !tag.empty(); tag.resize(tag.rfind('-') == std::string::npos ? 0 : tag.rfind('-')))
    candidates.add(std::string_view(tag + "-x-icu"));
  candidates.add(std::string_view("und-x-icu"));
  auto row = STRATA_TRY(connection.query(
      "SELECT c.collname FROM unnest($1::text[]) WITH ORDINALITY AS w (name, place) JOIN pg_collation c ON "
      "lower(c.collname) = lower(w.name) AND c.collprovider = 'i' AND c.collnamespace = 'pg_catalog'::regnamespace "
      "ORDER BY w.place LIMIT 1",
      Params().array(candidates)));
  return row.rows() == 0 ? std::string() : row.text(0, 0);
}

Result<std::vector<std::int64_t>> keys_in_order(PgConnection& connection, TableId table_id,
                                                Role seen_by, const std::string& collation,
                                                int depth) {
  // Title columns can contain records of other tables, in a cycle too, so the depth is limited.
  constexpr int kDeepest = 3;
  auto open = STRATA_TRY(read_table(connection, table_id, seen_by));
  std::vector<RecordOrder> order;
  const auto terms = term_columns(open.table);
  if (const Column* title = name_column(open.table); !terms && title) {
    order.push_back({title->id, false, collation});
    if (title->kind == ColumnKind::term) {
      auto keys = depth == kDeepest
                      ? Result<std::vector<std::int64_t>>(std::vector<std::int64_t>())
                      : keys_in_order(connection, *title->target, seen_by, collation, depth + 1);
      if (!keys) return tl::unexpected(keys.error());
      order.back().keys = std::move(*keys);
    }
  }
  auto page =
      load_page(connection, table_id, open.table.columns, {}, {}, Params(), order, {kMaxRecords});
  if (!page) return tl::unexpected(page.error());
  std::vector<std::int64_t> keys;
  if (terms)
    for (const ListedTerm& listed : list_terms(*terms, page->rows)) keys.push_back(listed.key);
  else
    for (const Record& row : page->rows) keys.push_back(row.key);
  return keys;
}

Result<std::vector<KeyNumber>> load_numbers(PgConnection& connection, TableId table_id,
                                            const std::vector<Column>& columns,
                                            const std::optional<std::vector<Record>>& past,
                                            const std::string& number, Params params) {
  const std::string from = from_rows(table_id, columns, past, params);
  auto rows = STRATA_TRY(connection.query_once("SELECT key, value FROM (SELECT key, (" + number +
                                                   ")::float8 AS value" + from +
                                                   ") n WHERE value IS NOT NULL",
                                               params));
  std::vector<KeyNumber> numbers;
  numbers.reserve(static_cast<std::size_t>(rows.rows()));
  for (int i = 0; i < rows.rows(); ++i)
    numbers.push_back({static_cast<std::uint32_t>(rows.integer(i, 0)), rows.real(i, 1)});
  return numbers;
}

Result<void> delete_rows(PgConnection& connection, TableId table_id,
                         std::span<const std::int64_t> keys) {
  auto done = connection.query_once("DELETE FROM " + table_name(table_id) + " WHERE key = any($1)",
                                    Params().array(array_of(keys)));
  return done ? Result<void>{} : tl::unexpected(done.error());
}

Result<void> insert_rows(PgConnection& connection, TableId table_id,
                         const std::vector<Column>& columns, std::span<const Record> rows) {
  const std::string name = table_name(table_id);
  for (std::size_t begin = 0; begin < rows.size(); begin += kRowsAtOnce) {
    const auto part = rows.subspan(begin, std::min(kRowsAtOnce, rows.size() - begin));
    STRATA_TRY(connection.query_once(
        "INSERT INTO " + name + " SELECT * FROM jsonb_populate_recordset(NULL::" + name + ", $1)",
        Params().json(rows_json(columns, part))));
  }
  return {};
}

Result<std::optional<Taken>> taken_value(PgConnection& connection, TableId table_id,
                                         const Column& column, std::span<const Record> rows) {
  const std::string name = table_name(table_id), of_column = column_name(column);
  std::map<std::string, std::int64_t> met;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto value = rows[i].values.find(column.id);
    if (value == rows[i].values.end() || value->second.is_null()) continue;
    const auto [first, is_first] = met.emplace(value->second.dump(), rows[i].key);
    if (!is_first) return std::optional(Taken{i, first->second, true});
  }
  if (met.empty()) return std::optional<Taken>();
  auto row = STRATA_TRY(connection.query_once(
      "SELECT i.key, t.key FROM jsonb_populate_recordset(NULL::" + name + ", $1) i JOIN " + name +
          " t ON t." + of_column + " = i." + of_column + " LIMIT 1",
      Params().json(rows_json({column}, rows))));
  if (row.rows() == 0) return std::optional<Taken>();
  std::size_t at = 0;
  while (at + 1 < rows.size() && rows[at].key != row.integer(0, 0)) ++at;
  return std::optional(Taken{at, row.integer(0, 1)});
}

Result<std::optional<std::pair<std::int64_t, std::int64_t>>> twins(PgConnection& connection,
                                                                   TableId table_id,
                                                                   const Column& column) {
  const std::string of_column = column_name(column);
  auto row = STRATA_TRY(connection.query_once(
      "SELECT min(key), max(key) FROM " + table_name(table_id) + " WHERE " + of_column +
      " IS NOT NULL GROUP BY " + of_column + " HAVING count(*) > 1 LIMIT 1"));
  if (row.rows() == 0) return std::optional<std::pair<std::int64_t, std::int64_t>>();
  return std::optional(std::pair(row.integer(0, 0), row.integer(0, 1)));
}

Result<std::vector<std::int64_t>> missing_rows(PgConnection& connection, TableId table_id,
                                               std::span<const std::int64_t> keys) {
  auto rows = STRATA_TRY(connection.query_once(
      "SELECT DISTINCT k FROM unnest($1::bigint[]) k WHERE NOT EXISTS (SELECT 1 FROM " +
          table_name(table_id) + " t WHERE t.key = k) ORDER BY k",
      Params().array(array_of(keys))));
  std::vector<std::int64_t> missing;
  for (int i = 0; i < rows.rows(); ++i) missing.push_back(rows.integer(i, 0));
  return missing;
}

Result<std::optional<std::pair<std::int64_t, std::int64_t>>> row_naming(
    PgConnection& connection, TableId table_id, const Column& column,
    std::span<const std::int64_t> keys) {
  const std::string name = column_name(column);
  const std::string sql = column.kind == ColumnKind::term
                              ? "SELECT key, " + name + " FROM " + table_name(table_id) +
                                    " WHERE " + name + " = any($1) LIMIT 1"
                              : "SELECT key, k FROM " + table_name(table_id) + ", unnest(" + name +
                                    ") k WHERE k = any($1) LIMIT 1";
  auto row = STRATA_TRY(connection.query_once(sql, Params().array(array_of(keys))));
  if (row.rows() == 0) return std::optional<std::pair<std::int64_t, std::int64_t>>();
  return std::optional(std::pair(row.integer(0, 0), row.integer(0, 1)));
}

Result<std::vector<std::int64_t>> rows_holding(PgConnection& connection, TableId table_id,
                                               const Column& column, AttachmentId attachment) {
  auto rows = STRATA_TRY(connection.query_once("SELECT key FROM " + table_name(table_id) +
                                                   " WHERE $1 = any(" + column_name(column) +
                                                   ") ORDER BY key",
                                               Params().id(attachment)));
  std::vector<std::int64_t> keys;
  for (int i = 0; i < rows.rows(); ++i) keys.push_back(rows.integer(i, 0));
  return keys;
}

}  // namespace strata::store
