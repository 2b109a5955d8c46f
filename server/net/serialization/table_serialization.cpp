#include "net/serialization/table_serialization.h"

#include "core/text/slug.h"
#include "core/text/timestamp.h"
#include "core/text/utf8.h"
#include "net/http/http_types.h"
#include "store/tables/tables.h"

namespace strata::net {
Result<Table> table_of_project(store::Store& store, ProjectId project_id,
                               const protocol::TableRef& ref, const std::string& field) {
  const std::string name = protocol::to_ref(ref);
  auto table = store.tables().find(name, Role::curator);
  if (!table && table.error().code != ErrorCode::not_found) return table;
  if (!table || table->project_id != project_id)
    return fail(ErrorCode::invalid, "Table not found", "The project has no table `" + name + "`.",
                field);
  return table;
}

Result<Column> new_column(store::Store& store, ProjectId project_id,
                          const protocol::ColumnCreate& body, const std::string& target_field) {
  Column column;
  column.name = body.name;
  if (body.slug) column.slug = make_slug(*body.slug);
  if (body.labels) column.labels = *body.labels;
  column.kind = *parse_column_kind(protocol::name(body.kind));
  column.unit = body.unit;
  column.required = body.required;
  column.unique = body.unique;
  if (body.default_value) column.default_value = *body.default_value;
  column.comment = body.comment;
  if (body.choices) column.choices = *body.choices;
  if (body.target) {
    auto table = STRATA_TRY(table_of_project(store, project_id, *body.target, target_field));
    column.target = table.id;
  }
  column.minimum = body.minimum;
  column.maximum = body.maximum;
  column.visibility = body.visibility.value_or(Visibility::everyone);
  return column;
}

Result<std::vector<Column>> new_columns(store::Store& store, ProjectId project_id,
                                        const std::vector<protocol::ColumnCreate>& requested) {
  std::vector<Column> columns;
  for (std::size_t i = 0; i < requested.size(); ++i) {
    auto column =
        new_column(store, project_id, requested[i], "columns[" + std::to_string(i) + "].target");
    if (!column) return tl::unexpected(column.error());
    columns.push_back(std::move(*column));
  }
  return columns;
}

Result<std::map<ColumnId, nlohmann::json>> values_by_column(const Table& table,
                                                            const nlohmann::json& values,
                                                            const std::string& field) {
  std::map<ColumnId, nlohmann::json> by_column;
  for (const auto& [ref, value] : values.items()) {
    const Column* column = find_column(table.columns, ref);
    const std::string shown = mended_utf8(ref.substr(0, 100));
    if (!column)
      return fail(ErrorCode::invalid, "Column not found",
                  table.name + " has no column `" + shown + "`.", field + "." + shown);
    if (!by_column.emplace(column->id, value).second)
      return fail(ErrorCode::invalid, "Duplicate column",
                  "`" + column->slug + "` appears twice, by its slug and by its id. Send it once.",
                  field + "." + ref);
  }
  return by_column;
}

nlohmann::json to_json(const store::TableEditRow& row) {
  nlohmann::json changes = nlohmann::json::array();
  for (const auto& change : row.changes)
    changes.push_back({{change.is_column ? "column" : "record", change.id},
                       {"before", nlohmann::json(change.before)},
                       {"after", nlohmann::json(change.after)}});
  return {{"sequence", row.sequence},          {"user", row.user},
          {"time", utc_text(row.time)},        {"op", row.op},
          {"in_force", row.in_force},          {"changes", std::move(changes)},
          {"total_changes", row.total_changes}};
}

nlohmann::json to_json(const Attachment& attachment) {
  nlohmann::json json{{"id", attachment.id},
                      {"table", attachment.table_id},
                      {"name", attachment.name},
                      {"media_type", attachment.media_type},
                      {"bytes", attachment.bytes},
                      {"sha256", attachment.sha256},
                      {"user", attachment.user},
                      {"time", utc_text(attachment.time)},
                      {"visibility", name(attachment.visibility)}};
  if (attachment.width) json["width"] = *attachment.width;
  if (attachment.height) json["height"] = *attachment.height;
  return json;
}

Result<std::int64_t> sequence_at(store::Store& store, const Table& table, const std::string& text) {
  if (is_all_digits(text)) return parse_integer(text, 0, table.sequence, "at");
  // A plus in a query is decoded as a space.
  std::string plain = text;
  if (const auto blank = plain.rfind(' '); blank != std::string::npos && blank > 11)
    plain[blank] = '+';
  const auto utc = utc_timestamp(plain);
  if (!utc)
    return fail(ErrorCode::invalid, "Invalid time",
                "`at` must be a sequence of the table, or a time such as 2024-02-29T12:00:00Z.",
                "at");
  return store.tables().sequence_at(table.id, *utc);
}

}  // namespace strata::net
