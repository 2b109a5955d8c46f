#include "store/tables/table_writer.h"

#include <algorithm>
#include <set>

#include "domain/tables/column_value.h"
#include "domain/tables/term_list.h"
#include "media/media_type.h"
#include "store/pg/pg_row.h"
#include "store/store_impl.h"
#include "store/tables/table_rows.h"

namespace strata::store {
namespace {

constexpr const char* kExists = "exists";
constexpr const char* kHidden = "hidden";

Labels labels_of(const nlohmann::json& json) {
  return json.is_object() ? json.get<Labels>() : Labels();
}

template <class T>
std::optional<T> optional_of(const nlohmann::json& json) {
  return json.is_null() ? std::nullopt : std::optional<T>(json.get<T>());
}

nlohmann::json properties_of(const Column& column) {
  return {{"name", column.name},
          {"slug", column.slug},
          {"labels", column.labels},
          {"unit", column.unit},
          {"required", column.required},
          {"unique", column.unique},
          {"default", column.default_value},
          {"comment", column.comment},
          {"choices", column.choices},
          {"minimum", column.minimum ? nlohmann::json(*column.minimum) : nlohmann::json()},
          {"maximum", column.maximum ? nlohmann::json(*column.maximum) : nlohmann::json()},
          {"order", column.order}};
}

void set_properties(Column& column, const nlohmann::json& properties) {
  column.name = properties.at("name").get<std::string>();
  column.slug = properties.at("slug").get<std::string>();
  column.labels = labels_of(properties.at("labels"));
  column.unit = properties.at("unit").get<std::string>();
  column.required = properties.at("required").get<bool>();
  column.unique = properties.at("unique").get<bool>();
  column.default_value = properties.at("default");
  column.comment = properties.at("comment").get<std::string>();
  column.choices = properties.at("choices").get<std::vector<std::string>>();
  column.minimum = optional_of<double>(properties.at("minimum"));
  column.maximum = optional_of<double>(properties.at("maximum"));
  column.order = properties.at("order").get<int>();
}

void show_columns(OpenTable& open) {
  open.table.columns.clear();
  for (const Column& column : open.all)
    if (!column.hidden && sees(open.seen_by, column.visibility))
      open.table.columns.push_back(column);
  std::stable_sort(open.table.columns.begin(), open.table.columns.end(),
                   [](const Column& a, const Column& b) { return a.order < b.order; });
}

Column* column_by_id(OpenTable& open, ColumnId id) {
  for (Column& column : open.all)
    if (column.id == id) return &column;
  return nullptr;
}

// Adds the keys that a value names.
void add_keys(const nlohmann::json& value, std::set<std::int64_t>& keys) {
  if (value.is_array())
    for (const auto& key : value) keys.insert(key.get<std::int64_t>());
  else if (!value.is_null())
    keys.insert(value.get<std::int64_t>());
}

std::string field_of(const Column& column) { return "values." + column.slug; }

Cells written_part(const Cells& now, const Cells& after) {
  Cells part;
  for (const auto& [name, value] : after) {
    const auto found = now.find(name);
    part[name] = found == now.end() ? nlohmann::json() : found->second;
  }
  return part;
}

// Writes one edit into a table.
class Writer {
 public:
  Writer(PgConnection& connection, OpenTable& open, TableEdit edit)
      : connection_(connection), open_(open), edit_(std::move(edit)) {}

  Result<TableChange> write() {
    for (auto step : {&Writer::change_columns, &Writer::change_records, &Writer::keep_columns}) {
      STRATA_TRY((this->*step)());
      if (!change_.problems.empty()) {
        change_.table = open_.table;
        return std::move(change_);
      }
    }
    STRATA_TRY(keep_entry());
    change_.sequence = sequence_;
    change_.record = edit_.record;
    change_.table = open_.table;
    return std::move(change_);
  }

 private:
  // Changes the column definitions. Removed columns are hidden first, so that an added column may
  // use their slug.
  Result<void> change_columns() {
    for (auto& [id, after] : edit_.columns)
      before_columns_[id] = written_part(cells_of(*column_by_id(open_, id)), after);
    put_cells(open_, edit_.columns);
    for (const bool hidden : {true, false})
      for (const auto& [id, after] : edit_.columns) {
        const Column& column = *column_by_id(open_, id);
        if (column.hidden != hidden) continue;
        if (column.hidden || !column.unique)
          STRATA_TRY(drop_unique_index(connection_, open_.table.id, column));
        STRATA_TRY(update_column(column));
      }
    change_.columns_changed = !edit_.columns.empty();
    return {};
  }

  Result<void> update_column(const Column& column) {
    auto slugs = STRATA_TRY(connection_.query(
        "SELECT 1 FROM record_columns WHERE table_id = $1 AND id <> $2 AND NOT hidden AND properties ->> 'slug' = $3",
        Params().id(open_.table.id).id(column.id).text(column.slug)));
    if (!column.hidden && slugs.rows() > 0)
      return fail(ErrorCode::conflict, "Slug already used",
                  "The table has another column `" + column.slug + "`. Rename that column first.",
                  "slug");
    auto done = connection_.query(
        "UPDATE record_columns SET properties = $2, hidden = $3 WHERE id = $1",
        Params().id(column.id).json(properties_of(column)).boolean(column.hidden));
    return done ? Result<void>{} : tl::unexpected(done.error());
  }

  Result<void> change_records() {
    if (edit_.records.empty()) return {};
    std::vector<std::int64_t> keys;
    for (const auto& [key, after] : edit_.records) keys.push_back(key);
    auto rows = STRATA_TRY(load_rows(connection_, open_.table.id, open_.all, keys));
    std::map<std::int64_t, Record> now;
    for (Record& row : rows) now[row.key] = std::move(row);

    std::vector<Record> then;
    for (auto& [key, after] : edit_.records) {
      const auto found = now.find(key);
      const bool existed = found != now.end();
      Cells cells{{kExists, existed}};
      if (existed)
        for (const auto& [id, value] : found->second.values) cells[to_string(id)] = value;
      before_records_[key] = written_part(cells, after);
      for (const auto& [name, value] : after) cells[name] = value;
      const bool exists = cells.at(kExists) == true;
      if (exists) {
        Record record{key, sequence_, {}};
        for (const Column& column : open_.all)
          if (const auto cell = cells.find(to_string(column.id));
              cell != cells.end() && !cell->second.is_null())
            record.values[column.id] = cell->second;
        then.push_back(std::move(record));
      }
      if (exists) (existed ? change_.changed : change_.created).push_back(key);
      if (existed && !exists) change_.deleted.push_back(key);
    }
    records_ = open_.table.records + static_cast<std::int64_t>(change_.created.size()) -
               static_cast<std::int64_t>(change_.deleted.size());
    if (records_ > kMaxRecords)
      return fail(ErrorCode::conflict, "Table full",
                  "A table can have at most " + std::to_string(kMaxRecords) +
                      " records. Delete some records, or use another table.");
    for (const Record& record : then) check_record(record);
    if (!change_.problems.empty()) return {};
    STRATA_TRY(delete_rows(connection_, open_.table.id, keys));
    for (const Column& column : open_.table.columns) {
      if (!column.unique) continue;
      auto taken = STRATA_TRY(taken_value(connection_, open_.table.id, column, then));
      if (taken)
        add_problem(then[taken->row].key,
                    {ErrorCode::conflict, "Value is not unique",
                     (taken->by_sent ? "Another record of this request has the same value of \""
                                     : "Record " + std::to_string(taken->by_key) +
                                           " already has this value of \"") +
                         column.name + "\".",
                     field_of(column)});
    }
    if (!change_.problems.empty()) return {};
    STRATA_TRY(insert_rows(connection_, open_.table.id, open_.all, then));
    for (const Column& column : open_.table.columns) {
      if (column.target) STRATA_TRY(check_targets(column, then));
      if (holds_attachments(column.kind)) STRATA_TRY(check_attached(column, then));
      if (holds_features(column.kind)) STRATA_TRY(check_marked(column, then));
    }
    STRATA_TRY(check_named());
    change_.records = std::move(then);
    return {};
  }

  // The caller checks new values. Past values were valid for the columns of their time, so they are
  // checked again for the current columns.
  void check_record(const Record& record) {
    const Cells& after = edit_.records.at(record.key);
    for (const Column& column : open_.table.columns) {
      const auto value = record.values.find(column.id);
      const nlohmann::json held = value == record.values.end() ? nlohmann::json() : value->second;
      if (column.unique && held.is_string() &&
          held.get_ref<const std::string&>().size() > kMaxUniqueTextLength)
        add_problem(record.key,
                    {ErrorCode::invalid, "Text too long",
                     "Texts of a unique column can have at most " +
                         std::to_string(kMaxUniqueTextLength) + " bytes. Shorten the text.",
                     field_of(column)});
      const bool is_written = after.contains(to_string(column.id)) || after.contains(kExists);
      if (!is_written || (!edit_.checks_values && !(column.required && held.is_null()))) continue;
      if (auto good = check_value(column, held, field_of(column)); !good)
        add_problem(record.key, good.error());
    }
  }

  // Checks that terms and relations name existing records.
  Result<void> check_targets(const Column& column, std::span<const Record> rows) {
    std::set<std::int64_t> named;
    for (const Record& row : rows)
      if (const auto value = row.values.find(column.id); value != row.values.end())
        add_keys(value->second, named);
    auto missing =
        missing_rows(connection_, *column.target, std::vector(named.begin(), named.end()));
    if (!missing || missing->empty())
      return missing ? Result<void>{} : tl::unexpected(missing.error());
    for (const Record& row : rows) {
      std::set<std::int64_t> keys;
      if (const auto value = row.values.find(column.id); value != row.values.end())
        add_keys(value->second, keys);
      for (const auto key : keys)
        if (std::binary_search(missing->begin(), missing->end(), key)) {
          add_problem(row.key, {ErrorCode::invalid, "Record not found",
                                "\"" + column.name + "\" refers to record " + std::to_string(key) +
                                    ", which does not exist.",
                                field_of(column)});
          break;
        }
    }
    return {};
  }

  // Checks that cells list only attachments of the table, and picture columns only pictures.
  Result<void> check_attached(const Column& column, std::span<const Record> rows) {
    std::set<std::int64_t> listed;
    for (const Record& row : rows)
      if (const auto value = row.values.find(column.id); value != row.values.end())
        add_keys(value->second, listed);
    if (listed.empty()) return {};
    PgArray ids(oid::kInt8);
    for (const auto id : listed) ids.add(id);
    auto known = STRATA_TRY(connection_.query(
        "SELECT id, media_type FROM attachments WHERE table_id = $1 AND id = any($2)",
        Params().id(open_.table.id).array(ids)));
    std::map<std::int64_t, std::string> types;
    for (int i = 0; i < known.rows(); ++i) types[known.integer(i, 0)] = known.text(i, 1);
    for (const Record& row : rows) {
      const auto value = row.values.find(column.id);
      if (value == row.values.end() || value->second.is_null()) continue;
      for (const auto& item : value->second) {
        const std::string id = std::to_string(item.get<std::int64_t>());
        const auto type = types.find(item.get<std::int64_t>());
        const bool is_there = type != types.end();
        if (is_there && (column.kind == ColumnKind::document || is_raster_picture(type->second)))
          continue;
        add_problem(
            row.key,
            {ErrorCode::invalid, is_there ? "Not a picture" : "Attachment not found",
             "\"" + column.name + "\" refers to attachment " + id +
                 (is_there ? ", which is " + type->second + ". Attach it to a column of documents."
                           : ", which the table does not have."),
             field_of(column)});
        break;
      }
    }
    return {};
  }

  // Checks that written lines and points are on models of the project. Existing lines and points
  // may be on a deleted model, and undo may restore them.
  Result<void> check_marked(const Column& column, std::span<const Record> rows) {
    if (edit_.checks_values) return {};
    auto models = STRATA_TRY(connection_.query("SELECT id FROM models WHERE project_id = $1",
                                               Params().id(open_.table.project_id)));
    std::set<ModelId> known;
    for (int i = 0; i < models.rows(); ++i) known.insert(models.id<ModelId>(i, 0));
    for (const Record& row : rows) {
      const auto value = row.values.find(column.id);
      const Cells& after = edit_.records.at(row.key);
      if (value == row.values.end() || value->second.is_null()) continue;
      if (!after.contains(to_string(column.id)) && !after.contains(kExists)) continue;
      for (const auto& feature : value->second) {
        const auto model = feature.at("model").get<ModelId>();
        if (known.contains(model)) continue;
        add_problem(row.key, {ErrorCode::invalid, "Model not found",
                              "\"" + column.name + "\" is on the model " + to_string(model) +
                                  ", which the project does not have.",
                              field_of(column)});
        break;
      }
    }
    return {};
  }

  // Checks that no other record names a deleted record.
  Result<void> check_named() {
    if (change_.deleted.empty()) return {};
    auto rows = STRATA_TRY(connection_.query(
        "SELECT c.id, c.kind, c.table_id, c.properties ->> 'name', t.name FROM record_columns c "
        "JOIN record_tables t ON t.id = c.table_id WHERE c.target = $1 AND NOT c.hidden ORDER BY c.id",
        Params().id(open_.table.id)));
    for (int i = 0; i < rows.rows(); ++i) {
      Column column;
      column.id = rows.id<ColumnId>(i, 0);
      column.kind = rows.text(i, 1) == "term" ? ColumnKind::term : ColumnKind::relation;
      auto naming =
          STRATA_TRY(row_naming(connection_, rows.id<TableId>(i, 2), column, change_.deleted));
      if (!naming) continue;
      const auto [by, key] = *naming;
      add_problem(key, {ErrorCode::conflict,
                        "Record in use",
                        "Record " + std::to_string(by) + " of " + rows.text(i, 4) +
                            " refers to record " + std::to_string(key) + " as \"" +
                            rows.text(i, 3) + "\". Change that record first.",
                        {}});
    }
    return {};
  }

  // Checks that all records satisfy a new column, or a column with stricter rules.
  Result<void> keep_columns() {
    for (const auto& [id, after] : edit_.columns) {
      const Column& column = *column_by_id(open_, id);
      const bool asks = std::any_of(after.begin(), after.end(), [](const auto& cell) {
        return cell.first == kHidden || cell.first == "required" || cell.first == "unique" ||
               cell.first == "choices" || cell.first == "minimum" || cell.first == "maximum";
      });
      if (column.hidden || !asks) continue;
      auto rows = STRATA_TRY(load_all_rows(connection_, open_.table.id, {column}));
      for (const Record& row : rows) {
        const auto value = row.values.find(id);
        const nlohmann::json held = value == row.values.end() ? nlohmann::json() : value->second;
        auto good = check_value(column, held, "column");
        if (!good)
          return fail(ErrorCode::conflict, "Values do not match",
                      "Record " + std::to_string(row.key) + ": " + good.error().detail +
                          " Change the records first.",
                      "column");
        if (column.unique && held.is_string() &&
            held.get_ref<const std::string&>().size() > kMaxUniqueTextLength)
          return fail(ErrorCode::conflict, "Values do not match",
                      "Record " + std::to_string(row.key) +
                          ": texts of a unique column can have at most " +
                          std::to_string(kMaxUniqueTextLength) + " bytes. Shorten the text first.",
                      "unique");
      }
      if (column.target || holds_attachments(column.kind)) {
        STRATA_TRY(column.target ? check_targets(column, rows) : check_attached(column, rows));
        if (!change_.problems.empty()) {
          Error problem = change_.problems.front().problem;
          return fail(
              ErrorCode::conflict, "Values do not match",
              "Record " + std::to_string(change_.problems.front().key) + ": " + problem.detail,
              "column");
        }
      }
      if (!column.unique) continue;
      auto same = STRATA_TRY(twins(connection_, open_.table.id, column));
      if (same)
        return fail(ErrorCode::conflict, "Value is not unique",
                    "Records " + std::to_string(same->first) + " and " +
                        std::to_string(same->second) + " have the same value of \"" + column.name +
                        "\".",
                    "unique");
      STRATA_TRY(make_unique_index(connection_, open_.table.id, column));
    }
    return {};
  }

  Result<void> keep_entry() {
    STRATA_TRY(connection_.query(
        "INSERT INTO table_edits (table_id, sequence, user_name, op, record) VALUES ($1, $2, $3, $4, $5)",
        Params()
            .id(open_.table.id)
            .integer(sequence_)
            .text(edit_.user)
            .text(edit_.op)
            .json(edit_.record)));
    STRATA_TRY(keep_cells("record", edit_.records, before_records_));
    STRATA_TRY(keep_cells("column", edit_.columns, before_columns_));
    for (const auto key : change_.created) open_.next_key = std::max(open_.next_key, key + 1);
    open_.table.sequence = sequence_;
    open_.table.records = records_;
    open_.table.version += change_.columns_changed;
    auto counted = connection_.query(
        "UPDATE record_tables SET sequence = $2, records = $3, next_key = $4, version = $5 WHERE id = $1",
        Params()
            .id(open_.table.id)
            .integer(sequence_)
            .integer(records_)
            .integer(open_.next_key)
            .integer(open_.table.version));
    if (!counted || !term_columns(open_.table))
      return counted ? Result<void>{} : tl::unexpected(counted.error());
    // Layers with the colors of the terms change, too (domain/tables/term_list, takes_term_colors).
    auto colored = connection_.query(
        "UPDATE layers SET version = version + 1 WHERE table_id = $1 AND palette ->> 'mode' = 'categorical' AND "
        "palette -> 'points' = '[]' AND coalesce(palette ->> 'column', '') = ''",
        Params().id(open_.table.id));
    return colored ? Result<void>{} : tl::unexpected(colored.error());
  }

  template <class Subject>
  Result<void> keep_cells(const char* subject, const std::map<Subject, Cells>& written,
                          const std::map<Subject, Cells>& before) {
    constexpr int kAtOnce = 5000;
    for (auto next = written.begin(); next != written.end();) {
      PgArray ids(oid::kInt8), befores(oid::kJsonb), afters(oid::kJsonb);
      for (int n = 0; n < kAtOnce && next != written.end(); ++n, ++next) {
        ids.add(next->first);
        befores.add(nlohmann::json(before.at(next->first)));
        afters.add(nlohmann::json(next->second));
      }
      STRATA_TRY(connection_.query(
          "INSERT INTO table_changes (table_id, sequence, subject, subject_id, before, after) "
          "SELECT $1, $2, $3, * FROM unnest($4::bigint[], $5::jsonb[], $6::jsonb[])",
          Params()
              .id(open_.table.id)
              .integer(sequence_)
              .text(subject)
              .array(ids)
              .array(befores)
              .array(afters)));
    }
    return {};
  }

  void add_problem(std::int64_t key, Error problem) {
    if (change_.problems.size() < kMaxRowProblems)
      change_.problems.push_back({key, std::move(problem), {}});
  }

  PgConnection& connection_;
  OpenTable& open_;
  TableEdit edit_;
  TableChange change_;
  const std::int64_t sequence_ = open_.table.sequence + 1;
  std::int64_t records_ = open_.table.records;
  std::map<std::int64_t, Cells> before_records_;
  std::map<ColumnId, Cells> before_columns_;
};

}  // namespace

Cells cells_of(const Column& column) {
  Cells cells = properties_of(column).get<Cells>();
  cells[kHidden] = column.hidden;
  return cells;
}

void put_cells(OpenTable& open, const std::map<ColumnId, Cells>& columns) {
  for (const auto& [id, cells] : columns) {
    Column* column = column_by_id(open, id);
    nlohmann::json properties = properties_of(*column);
    for (const auto& [name, value] : cells)
      if (name == kHidden)
        column->hidden = value.get<bool>();
      else
        properties[name] = value;
    set_properties(*column, properties);
  }
  show_columns(open);
}

Result<OpenTable> read_table(PgConnection& connection, TableId id, Role seen_by) {
  auto rows = STRATA_TRY(connection.query(
      "SELECT id, project_id, name, slug::text, labels, description, records, sequence, version, next_key, title_column "
      "FROM record_tables WHERE id = $1",
      Params().id(id)));
  if (rows.rows() == 0) return no_such("table", to_string(id));
  PgRow row(rows, 0);
  OpenTable open;
  open.seen_by = seen_by;
  open.table.id = row.id<TableId>();
  open.table.project_id = row.id<ProjectId>();
  open.table.name = row.text();
  open.table.slug = row.text();
  open.table.labels = labels_of(row.json());
  open.table.description = row.text();
  open.table.records = row.integer();
  open.table.sequence = row.integer();
  open.table.version = row.integer();
  open.next_key = row.integer();
  open.table.title_column = row.id<std::optional<ColumnId>>();
  auto columns = STRATA_TRY(connection.query(
      "SELECT id, kind, target, properties, hidden, visibility FROM record_columns WHERE table_id = $1 ORDER BY id",
      Params().id(id)));
  for (int i = 0; i < columns.rows(); ++i) {
    PgRow cells(columns, i);
    Column column;
    column.id = cells.id<ColumnId>();
    const auto kind = parse_column_kind(cells.text());
    if (!kind)
      return fail(ErrorCode::internal, "Damaged table",
                  "Column " + to_string(column.id) + " has an unknown kind.");
    column.kind = *kind;
    column.target = cells.id<std::optional<TableId>>();
    set_properties(column, cells.json());
    column.hidden = cells.boolean();
    // Replaces an unknown visibility by the most restricted one.
    column.visibility = parse_visibility(cells.text()).value_or(Visibility::curators);
    open.all.push_back(std::move(column));
  }
  show_columns(open);
  return open;
}

Result<OpenTable> lock_table(PgConnection& connection, TableId id) {
  STRATA_TRY(connection.query(
      "SELECT 1 FROM projects WHERE id = (SELECT project_id FROM record_tables WHERE id = $1) FOR NO KEY UPDATE",
      Params().id(id)));
  return read_table(connection, id);
}

Result<TableChange> apply_edit(PgConnection& connection, OpenTable& open, TableEdit edit) {
  return Writer(connection, open, std::move(edit)).write();
}

Result<void> fit_column(PgConnection& connection, const OpenTable& open, Column& column) {
  STRATA_TRY(check_column(column));
  if (column.target) {
    auto known =
        STRATA_TRY(connection.query("SELECT 1 FROM record_tables WHERE id = $1 AND project_id = $2",
                                    Params().id(*column.target).id(open.table.project_id)));
    if (known.rows() == 0)
      return fail(ErrorCode::invalid, "Table not found",
                  "The project has no table " + to_string(*column.target) + ".", "target");
    std::set<std::int64_t> named;
    add_keys(column.default_value, named);
    auto missing =
        missing_rows(connection, *column.target, std::vector(named.begin(), named.end()));
    if (!missing) return tl::unexpected(missing.error());
    if (!missing->empty())
      return fail(ErrorCode::invalid, "Record not found",
                  "There is no record " + std::to_string(missing->front()) + ".", "default");
  }
  const std::string requested = make_slug(column.slug.empty() ? column.name : column.slug);
  // These names are reserved in a list of records.
  std::set<std::string> used{"key", "version", "area-m2"};
  for (const Column& other : open.table.columns)
    if (other.id != column.id) used.insert(other.slug);
  if (!column.slug.empty() && used.contains(requested))
    return fail(ErrorCode::conflict, "Slug already used",
                "The table already has a column `" + requested + "`.", "slug");
  column.slug = requested;
  for (int n = 2; used.contains(column.slug); ++n)
    column.slug = requested + "-" + std::to_string(n);
  return {};
}

Result<Column> insert_column(PgConnection& connection, const OpenTable& open, Column column) {
  if (open.all.size() >= static_cast<std::size_t>(kMaxColumns))
    return fail(ErrorCode::conflict, "Too many columns",
                "A table can have at most " + std::to_string(kMaxColumns) +
                    " columns, including deleted columns.");
  column.hidden = true;
  auto row = STRATA_TRY(connection.query(
      "INSERT INTO record_columns (table_id, kind, target, properties, hidden, visibility) VALUES ($1, $2, $3, $4, true, $5) "
      "RETURNING id",
      Params()
          .id(open.table.id)
          .text(name(column.kind))
          .optional_id(column.target)
          .json(properties_of(column))
          .text(name(column.visibility))));
  column.id = row.id<ColumnId>(0, 0);
  STRATA_TRY(add_rows_column(connection, open.table.id, column));
  return column;
}

Result<Table> insert_table(PgConnection& connection, Table table) {
  STRATA_TRY(check_name(table.name));
  STRATA_TRY(check_text(table.slug, "slug"));
  STRATA_TRY(check_text(table.description, "description"));
  STRATA_TRY(check_labels(table.labels));
  auto project = STRATA_TRY(connection.query(
      "SELECT 1 FROM projects WHERE id = $1 FOR NO KEY UPDATE", Params().id(table.project_id)));
  if (project.rows() == 0) return no_such("project", to_string(table.project_id));
  auto row = STRATA_TRY(insert_with_slug(
      connection, "SELECT slug::text FROM record_tables WHERE slug LIKE $1", {},
      table.slug.empty() ? table.name : table.slug, [&](const std::string& slug) {
        return connection.query(
            "INSERT INTO record_tables (project_id, name, slug, labels, description) VALUES ($1, $2, $3, $4, $5) "
            "ON CONFLICT (slug) DO NOTHING RETURNING id",
            Params()
                .id(table.project_id)
                .text(table.name)
                .text(slug)
                .json(table.labels)
                .text(table.description));
      }));
  const TableId id = row.id<TableId>(0, 0);
  STRATA_TRY(make_rows_table(connection, id));
  auto open = STRATA_TRY(read_table(connection, id));
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    Column column = std::move(table.columns[i]);
    column.order = static_cast<int>(i);
    if (column.target == kOwnTable) column.target = id;
    const auto in_place = [&](Error problem) {
      problem.field =
          "columns[" + std::to_string(i) + "]" + (problem.field.empty() ? "" : "." + problem.field);
      return tl::unexpected(std::move(problem));
    };
    if (auto fits = fit_column(connection, open, column); !fits) return in_place(fits.error());
    auto inserted = insert_column(connection, open, std::move(column));
    if (!inserted) return in_place(inserted.error());
    inserted->hidden = false;
    STRATA_TRY(connection.query("UPDATE record_columns SET hidden = false WHERE id = $1",
                                Params().id(inserted->id)));
    if (inserted->unique) STRATA_TRY(make_unique_index(connection, id, *inserted));
    open.all.push_back(std::move(*inserted));
    show_columns(open);
  }
  return open.table;
}

}  // namespace strata::store
