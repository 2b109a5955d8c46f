#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "app/deposit/crate_json.h"
#include "app/deposit/import_parts.h"
#include "app/records/record_csv.h"
#include "domain/people/role.h"
#include "store/store.h"
#include "store/tables/attachments.h"
#include "store/tables/records.h"
#include "store/tables/tables.h"

namespace strata::app {
namespace {

using nlohmann::json;

// Values of these columns refer to other parts, which may not exist yet.
bool refers(const Column& column) {
  return column.target || holds_attachments(column.kind) || holds_features(column.kind);
}

tl::unexpected<Error> refused(const std::string& part, const Error& why) {
  return fail(ErrorCode::invalid, "Deposit not imported",
              part + " of the deposit cannot be imported: " + why.detail);
}

Result<void> make_table(const Import& import, Table table) {
  const TableId before = table.id;
  std::vector<Column> given = std::move(table.columns), later;
  table.columns.clear();
  table.id = {};
  table.project_id = import.made.project.id;
  for (Column& column : given) {
    Column fresh = column;
    fresh.id = {};
    if (refers(fresh)) fresh.required = false;
    const bool is_own = fresh.target == before;
    if (fresh.target && !is_own && !import.ids.tables.contains(*fresh.target)) continue;
    if (fresh.target) fresh.target = is_own ? kOwnTable : import.ids.tables.at(*fresh.target);
    table.columns.push_back(std::move(fresh));
  }
  const auto made = STRATA_TRY(import.store.tables().create(table));
  import.ids.tables[before] = made.id;
  for (const Column& column : given)
    if (const auto found = std::ranges::find(made.columns, column.slug, &Column::slug);
        found != made.columns.end())
      import.ids.columns[column.id] = found->id;
  ++import.made.tables;
  return {};
}

// Adds the columns whose tables did not exist yet, because tables refer to each other in a circle.
Result<void> add_missing_columns(const Import& import, const Table& table) {
  for (const Column& column : table.columns) {
    if (import.ids.columns.contains(column.id)) continue;
    Column fresh = column;
    fresh.id = {};
    fresh.required = false;
    const auto target =
        fresh.target ? import.ids.tables.find(*fresh.target) : import.ids.tables.end();
    if (target == import.ids.tables.end()) continue;  // the table is not in the deposit
    fresh.target = target->second;
    const auto change = STRATA_TRY(
        import.store.tables().create_column(import.ids.tables.at(table.id), fresh, kImporter));
    const auto made = std::ranges::find(change.table.columns, column.slug, &Column::slug);
    if (made != change.table.columns.end()) import.ids.columns[column.id] = made->id;
  }
  return {};
}

// Writes the records of one table.
class RecordImport {
 public:
  RecordImport(const Import& import, const json& all) : import_(import), all_(all) {
    stored_ = crate::table_of(all);
    id_ = import.ids.tables.at(stored_.id);
  }

  // First the values that refer to nothing, so that records can refer to each other.
  Result<void> write_plain() {
    import_.progress.report(0, "Writing the table " + stored_.name);
    return each_file([this](std::vector<store::RecordInput> records) -> Result<void> {
      import_.made.records += static_cast<std::int64_t>(records.size());
      for (store::RecordInput& record : records)
        for (const Column& column : table_.columns)
          // No value, instead of the default of the column.
          if (refers(column) || !record.values.contains(column.id))
            record.values[column.id] = nullptr;
      return write(std::move(records), true);
    });
  }

  Result<void> write_references() {
    STRATA_TRY(reload());
    STRATA_TRY(attach_files());
    STRATA_TRY(each_file([this](std::vector<store::RecordInput> records) -> Result<void> {
      std::vector<store::RecordInput> referring;
      for (store::RecordInput& record : records)
        if (keep_references(record)) referring.push_back(std::move(record));
      return referring.empty() ? Result<void>() : write(std::move(referring), false);
    }));
    return restore_properties();
  }

 private:
  using Work = std::function<Result<void>(std::vector<store::RecordInput>)>;

  Result<void> reload() {
    table_ = STRATA_TRY(import_.store.tables().find(to_string(id_), Role::owner));
    return {};
  }

  Result<void> each_file(const Work& work) {
    STRATA_TRY(reload());
    for (const json& path : all_.at("files")) {
      const auto file = STRATA_TRY(import_.open(path.get<std::string>()));
      auto rows = read_records_csv(file.view(), table_);
      if (!rows) return refused(path.get<std::string>(), rows.error());
      if (!rows->mistakes.empty())
        return refused("Line " + std::to_string(rows->mistakes.front().line) + " of " +
                           path.get<std::string>(),
                       rows->mistakes.front().problem);
      for (const store::RecordInput& record : rows->records)
        if (!record.key) return damaged(path.get<std::string>(), "has a row without a key");
      if (import_.progress.cancelled()) return cancelled_problem();
      if (!rows->records.empty()) STRATA_TRY(work(std::move(rows->records)));
    }
    return {};
  }

  Result<void> write(std::vector<store::RecordInput> records, bool creates) {
    store::WriteRecords request;
    request.records = std::move(records);
    request.may_create = creates;
    request.may_change = !creates;
    request.op = "import";
    const auto change = STRATA_TRY(import_.store.records().write(id_, request, kImporter));
    if (!change.problems.empty())
      return refused(
          "Record " + std::to_string(change.problems.front().key) + " of the table " + stored_.name,
          change.problems.front().problem);
    return {};
  }

  // Removes the other values, and replaces the ids of models and files. Returns false if no value
  // remains.
  bool keep_references(store::RecordInput& record) const {
    for (const Column& column : table_.columns) {
      const auto value = record.values.find(column.id);
      if (value == record.values.end()) continue;
      if (!refers(column) || value->second.is_null()) {
        record.values.erase(value);
        continue;
      }
      json kept = json::array();
      for (const json& item : value->second.is_array() ? value->second : json::array()) {
        json fresh = item;
        if (holds_attachments(column.kind)) {
          const auto id = attachments_.find(item.get<AttachmentId>());
          if (id == attachments_.end()) continue;
          fresh = id->second;
        } else if (holds_features(column.kind)) {
          const auto model = import_.ids.models.find(item.at("model").get<ModelId>());
          if (model == import_.ids.models.end()) continue;  // deleted before the deposit
          fresh["model"] = model->second;
        }
        kept.push_back(std::move(fresh));
      }
      if (value->second.is_array()) value->second = kept.empty() ? json() : std::move(kept);
    }
    return !record.values.empty();
  }

  // Attaches each file to the first cell that lists it. write_references then sets the cells.
  Result<void> attach_files() {
    std::map<AttachmentId, const json*> files;
    for (const json& file : all_.at("attachments"))
      files[file.at("id").get<AttachmentId>()] = &file;
    if (files.empty()) return {};
    return each_file([&](const std::vector<store::RecordInput>& records) -> Result<void> {
      for (const store::RecordInput& record : records)
        for (const Column& column : table_.columns) {
          const auto value = record.values.find(column.id);
          if (!holds_attachments(column.kind) || value == record.values.end()) continue;
          for (const json& id : value->second.is_null() ? json::array() : value->second)
            if (const auto file = files.find(id.get<AttachmentId>());
                file != files.end() && !attachments_.contains(file->first))
              STRATA_TRY(attach(*file->second, *record.key, column.id));
        }
      return {};
    });
  }

  Result<void> attach(const json& stored, std::int64_t key, ColumnId column) {
    const auto path = stored.at("file").get<std::string>();
    const auto mapped = STRATA_TRY(import_.open(path));
    store::NewAttachment file;
    file.name = stored.at("name").get<std::string>();
    file.file = STRATA_TRY(import_.place_of(path));
    const FileFacts facts = facts_of(mapped, file.name);
    file.media_type = facts.media_type;
    file.width = facts.width;
    file.height = facts.height;
    file.visibility =
        parse_visibility(stored.at("visibility").get<std::string>()).value_or(Visibility::curators);
    const auto attached =
        import_.store.attachments().attach(id_, key, column, {file}, std::nullopt,
                                           {stored.at("user").get<std::string>(), Role::owner});
    if (!attached) return refused(path, attached.error());
    attachments_[stored.at("id").get<AttachmentId>()] = attached->attachments.front().id;
    ++import_.made.files;
    return {};
  }

  // Sets the properties that would have refused incomplete records.
  Result<void> restore_properties() {
    for (const Column& stored : stored_.columns) {
      const auto column = std::ranges::find(table_.columns, stored.slug, &Column::slug);
      if (column == table_.columns.end() || !stored.required || column->required) continue;
      Column changed = *column;
      changed.required = true;
      const auto done = import_.store.tables().update_column(id_, changed, std::nullopt, kImporter);
      if (!done) return refused("The table " + stored_.name, done.error());
    }
    const json& title = all_.at("title_column");
    if (title.is_null()) return {};
    STRATA_TRY(reload());
    const auto column = std::ranges::find(table_.columns, title.get<std::string>(), &Column::slug);
    if (column == table_.columns.end()) return {};
    table_.title_column = column->id;
    STRATA_TRY(import_.store.tables().update(table_));
    return {};
  }

  const Import& import_;
  const json& all_;
  Table stored_;  // with the ids of the deposit
  TableId id_;
  Table table_;
  std::map<AttachmentId, AttachmentId> attachments_;
};

}  // namespace

Result<void> import_tables(const Import& import, const json& tables) {
  std::vector<Table> waiting;
  for (const json& each : tables) waiting.push_back(crate::table_of(each));
  const std::vector<Table> all = waiting;
  // A table is made after the tables that its columns name, unless they form a circle.
  while (!waiting.empty()) {
    const auto is_ready = [&](const Table& table) {
      return std::ranges::all_of(table.columns, [&](const Column& column) {
        return !column.target || *column.target == table.id ||
               import.ids.tables.contains(*column.target) ||
               std::ranges::find(waiting, *column.target, &Table::id) == waiting.end();
      });
    };
    auto next = std::ranges::find_if(waiting, is_ready);
    if (next == waiting.end()) next = waiting.begin();
    STRATA_TRY(make_table(import, *next));
    waiting.erase(next);
  }
  for (const Table& table : all) STRATA_TRY(add_missing_columns(import, table));
  return {};
}

Result<void> import_records(const Import& import, const json& tables) {
  std::vector<RecordImport> imports;
  for (const json& each : tables) imports.emplace_back(import, each);
  for (RecordImport& table : imports) STRATA_TRY(table.write_plain());
  for (RecordImport& table : imports) STRATA_TRY(table.write_references());
  return {};
}

}  // namespace strata::app
