#include <algorithm>
#include <map>

#include "app/authorization/visibility_leak_check.h"
#include "app/change_notifier.h"
#include "app/records/painted_keys.h"
#include "core/compensated_sum.h"
#include "domain/layers/classification.h"
#include "domain/layers/key_colors.h"
#include "domain/layers/key_numbers.h"
#include "domain/people/role.h"
#include "domain/people/visibility.h"
#include "domain/tables/relation_cycles.h"
#include "domain/tables/table.h"
#include "expression/expression.h"
#include "net/api/addressed.h"
#include "net/api/route_help.h"
#include "net/api/routes.h"
#include "net/http/idempotency_store.h"
#include "net/http/page.h"
#include "net/live/live_sockets.h"
#include "net/live/table_events.h"
#include "net/serialization/table_serialization.h"
#include "net/transport/server_options.h"
#include "room/rooms.h"
#include "store/store.h"
#include "store/tables/records.h"
#include "store/tables/table_changes.h"
#include "store/tables/tables.h"

namespace strata::net {
namespace {

using TableChange = store::TableChange;

Result<Response> list_tables(const RouteContext& context, const Request& request) {
  auto page = STRATA_TRY(page_of(request));
  auto project = STRATA_TRY(stored_project(context, request));
  auto tables = STRATA_TRY(context.store.tables().of_project(project.id, request.role()));
  nlohmann::json list = nlohmann::json::array();
  const int total = static_cast<int>(tables.size());
  const auto part = STRATA_TRY(slice_by_name(page, tables, context.store, [](const Table& table) {
    return store::NamedId{table.name, table.id.number()};
  }));
  for (std::size_t i = part.begin; i < part.end; ++i) list.push_back(to_json(tables[i]));
  Response response = json_response({{"tables", list}, {"total", total}});
  add_page_links(response, request, page, part.last);
  return response;
}

Result<Response> create_table(const RouteContext& context, const Request& request) {
  auto body = STRATA_TRY(body_of<protocol::TableCreate>(request));
  auto project = STRATA_TRY(stored_project(context, request));
  auto slug = STRATA_TRY(slug_of(body.slug, body.name));
  Table table;
  table.project_id = project.id;
  table.name = body.name;
  table.slug = slug;
  if (body.labels) table.labels = *body.labels;
  table.description = body.description;
  if (body.columns) {
    auto columns = STRATA_TRY(new_columns(context.store, project.id, *body.columns));
    table.columns = std::move(columns);
  }
  const auto answer = [](const Table& made) {
    return json_response(to_json(made), 201)
        .with("Location", "/api/v1/tables/" + made.slug)
        .with("ETag", etag_of(made.version));
  };
  auto created =
      STRATA_TRY(context.store.tables().create(table, idempotent_response<Table>(request, answer)));
  tell_table(context.live_sockets, protocol::TableEventEvent::created, created, request.user());
  return answer(created);
}

Result<Response> change_table(const RouteContext& context, const Request& request) {
  auto table = STRATA_TRY(stored_table(context, request));
  STRATA_TRY(check_if_match(request, table.version));
  auto body = STRATA_TRY(body_of<protocol::TablePatch>(request));
  if (body.name) table.name = *body.name;
  if (body.labels) table.labels = *body.labels;
  if (body.description) table.description = *body.description;
  if (body.title_column) {
    const Column* title =
        body.title_column->empty() ? nullptr : find_column(table.columns, *body.title_column);
    if (!title && !body.title_column->empty())
      return fail(ErrorCode::invalid, "Column not found",
                  table.name + " has no column `" + *body.title_column + "`.", "title_column");
    table.title_column = title ? std::optional(title->id) : std::nullopt;
  }
  const auto answer = [](const Table& now) {
    return json_response(to_json(now)).with("ETag", etag_of(now.version));
  };
  auto changed =
      STRATA_TRY(context.store.tables().update(table, idempotent_response<Table>(request, answer)));
  tell_table(context.live_sockets, protocol::TableEventEvent::changed, changed, request.user());
  return answer(changed);
}

Result<Response> delete_table(const RouteContext& context, const Request& request) {
  auto table = STRATA_TRY(stored_table(context, request));
  STRATA_TRY(check_if_match(request, table.version));
  STRATA_TRY(context.store.tables().remove(
      table.id, idempotent_response<>(request, [] { return empty_response(204); })));
  tell_table(context.live_sockets, protocol::TableEventEvent::deleted, table, request.user());
  return empty_response(204);
}

// --- columns; If-Match contains the version of the table

std::optional<std::int64_t> expected_version(const Request& request, const Table& table) {
  return request.header("if-match").empty() ? std::nullopt : std::optional(table.version);
}

Result<const Column*> column_of(const Table& table, const Request& request) {
  const Column* column = find_column(table.columns, request.param("column"));
  if (!column)
    return fail(ErrorCode::not_found, "Not found",
                table.name + " has no column `" + request.param("column").substr(0, 100) + "`.");
  return column;
}

nlohmann::json column_json(const TableChange& change, ColumnId id) {
  nlohmann::json json{{"sequence", change.sequence ? change.sequence : change.table.sequence}};
  for (const Column& column : change.table.columns)
    if (column.id == id) json["column"] = to_json(column);
  for (const char* key : {"converted", "lost", "lost_keys"})
    if (change.record.contains(key)) json[key] = change.record.at(key);
  return json;
}

Result<Response> list_columns(const RouteContext& context, const Request& request) {
  const auto page = STRATA_TRY(page_of(request, kMaxPage));
  auto table = STRATA_TRY(stored_table(context, request));
  const auto part = STRATA_TRY(slice_by(page, table.columns, [](const Column& column) {
    return NumberKey{column.order, column.id.number()};
  }));
  nlohmann::json list = nlohmann::json::array();
  for (std::size_t i = part.begin; i < part.end; ++i) list.push_back(to_json(table.columns[i]));
  Response response =
      json_response({{"columns", std::move(list)}, {"total", table.columns.size()}});
  add_page_links(response, request, page, part.last);
  return with_etag(std::move(response), request, table.version);
}

Result<Response> create_column(const RouteContext& context, const Request& request) {
  auto body = STRATA_TRY(body_of<protocol::ColumnCreate>(request));
  auto table = STRATA_TRY(stored_table(context, request));
  STRATA_TRY(check_if_match(request, table.version));
  auto column = STRATA_TRY(new_column(context.store, table.project_id, body));
  for (const Column& other : table.columns) column.order = std::max(column.order, other.order + 1);
  const auto answer = [](const TableChange& change) {
    const ColumnId id = change.record.at("column").get<ColumnId>();
    return json_response(column_json(change, id), 201)
        .with("Location", "/api/v1/tables/" + change.table.slug + "/columns/" + to_string(id))
        .with("ETag", etag_of(change.table.version));
  };
  auto change = STRATA_TRY(context.store.tables().create_column(
      table.id, column, request.user(), idempotent_response<TableChange>(request, answer)));
  context.changes.records_changed(change, request.user());
  return answer(change);
}

// Null removes a default or a limit. The typed body has the same value for null and for an absent
// member, so this function reads the JSON.
Result<void> change(const RouteContext& context, const Request& request,
                    const protocol::ColumnPatch& patch, const Table& table, Column& column) {
  const auto body = nlohmann::json::parse(request.body);
  if (patch.name) column.name = *patch.name;
  if (patch.slug) {
    auto slug = STRATA_TRY(slug_of(patch.slug, column.name));
    column.slug = slug;
  }
  if (patch.labels) column.labels = *patch.labels;
  if (patch.kind) {
    column.kind = *parse_column_kind(protocol::name(*patch.kind));
    // Clears the properties that the new kind does not use, unless the patch sets them.
    const bool is_number = column.kind == ColumnKind::integer || column.kind == ColumnKind::numeric;
    if (!is_number) column.unit.clear(), column.minimum.reset(), column.maximum.reset();
    if (column.kind != ColumnKind::enumeration) column.choices.clear();
    if (column.kind != ColumnKind::term && column.kind != ColumnKind::relation)
      column.target.reset();
    if (!body.contains("default")) column.default_value = nullptr;
  }
  if (patch.unit) column.unit = *patch.unit;
  if (patch.required) column.required = *patch.required;
  if (patch.unique) column.unique = *patch.unique;
  if (body.contains("default")) column.default_value = body.at("default");
  if (patch.comment) column.comment = *patch.comment;
  if (patch.choices) column.choices = *patch.choices;
  if (patch.target) {
    auto target =
        STRATA_TRY(table_of_project(context.store, table.project_id, *patch.target, "target"));
    column.target = target.id;
  }
  if (body.contains("minimum")) column.minimum = patch.minimum;
  if (body.contains("maximum")) column.maximum = patch.maximum;
  if (patch.order) column.order = *patch.order;
  return {};
}

Result<Response> show_column(const RouteContext& context, const Request& request,
                             const Table& table, const Column& column, Visibility visibility) {
  STRATA_TRY(app::check_shows_nothing(context.store, table, column, visibility));
  const auto answer = [id = column.id](const Table& now) {
    TableChange shown;
    shown.table = now;
    return json_response(column_json(shown, id)).with("ETag", etag_of(now.version));
  };
  auto now = STRATA_TRY(context.store.tables().show_column(
      table.id, column.id, visibility, table.version, idempotent_response<Table>(request, answer)));
  // Some users can no longer see the column. Their views must show other colors, lines and points.
  context.rooms.records_changed(now.id);
  tell_table(context.live_sockets, protocol::TableEventEvent::changed, now, request.user());
  return answer(now);
}

Result<Response> change_column(const RouteContext& context, const Request& request) {
  auto table = STRATA_TRY(stored_table(context, request));
  auto found = STRATA_TRY(column_of(table, request));
  STRATA_TRY(check_if_match(request, table.version));
  auto body = STRATA_TRY(body_of<protocol::ColumnPatch>(request));
  if (body.visibility) {
    protocol::ColumnPatch alone;
    alone.visibility = body.visibility;
    if (!(body == alone))
      return fail(ErrorCode::invalid, "Visibility together with other changes",
                  "Change the visibility of a column in a separate request.", "visibility");
    return show_column(context, request, table, *found, *body.visibility);
  }
  Column column = *found;
  STRATA_TRY(change(context, request, body, table, column));
  const auto answer = [id = column.id](const TableChange& done) {
    const auto now = done.record.is_object() ? done.record.value("column", id) : id;
    return json_response(column_json(done, now)).with("ETag", etag_of(done.table.version));
  };
  auto done = context.store.tables().update_column(
      table.id, column, expected_version(request, table), request.user(),
      idempotent_response<TableChange>(request, answer));
  if (!done) return tl::unexpected(done.error());
  context.changes.records_changed(*done, request.user());
  return answer(*done);
}

Result<Response> drop_column(const RouteContext& context, const Request& request) {
  auto table = STRATA_TRY(stored_table(context, request));
  auto column = STRATA_TRY(column_of(table, request));
  STRATA_TRY(check_if_match(request, table.version));
  const auto answer = [](const TableChange&) { return empty_response(204); };
  auto done = context.store.tables().drop_column(table.id, column->id,
                                                 expected_version(request, table), request.user(),
                                                 idempotent_response<TableChange>(request, answer));
  if (!done) return tl::unexpected(done.error());
  context.changes.records_changed(*done, request.user());
  return answer(*done);
}

// Finds records that are above themselves in a hierarchy. The server reports such cycles instead of
// refusing them. Excavation drawings contain them, and users must find them.
Result<Response> cycles(const RouteContext& context, const Request& request) {
  auto table = STRATA_TRY(stored_table(context, request));
  auto column = STRATA_TRY(column_of(table, request));
  if (column->target != table.id)
    return fail(ErrorCode::invalid, "No relation to itself",
                "Only a relation or term column that refers to its own table can have cycles.",
                "column");
  store::RecordQuery query;
  query.limit = store::kMaxRecords;
  auto page = STRATA_TRY(context.store.records().page(table.id, request.role(), query));
  Relation relation;
  for (const Record& record : page.records)
    if (const auto named = record.values.find(column->id); named != record.values.end())
      relation[record.key] = named->second.is_array()
                                 ? named->second.get<std::vector<std::int64_t>>()
                                 : std::vector{named->second.get<std::int64_t>()};
  const auto found = relation_cycles(relation);
  return json_response({{"cycles", found}, {"total", found.size()}});
}

// --- classes and history

Result<Response> classes(const RouteContext& context, const Request& request) {
  auto table = STRATA_TRY(stored_table(context, request));
  auto column = STRATA_TRY(column_of(table, request));
  const auto parameter = request.query.find("method");
  const std::string method = parameter == request.query.end() ? "unique" : parameter->second;
  const bool unique = method == "unique";
  if (!unique && method != "equal" && method != "quantile")
    return fail(ErrorCode::invalid, "Unknown method",
                "The method must be equal, quantile or unique.", "method");
  int count = unique ? 20 : 5;
  if (const auto given = request.query.find("count"); given != request.query.end()) {
    auto number = parse_integer(given->second, 1, 1000, "count");
    if (!number) return tl::unexpected(number.error());
    count = static_cast<int>(*number);
  }
  nlohmann::json list = nlohmann::json::array();
  std::uint64_t with_value = 0, classified = 0;
  if (unique) {
    auto cells = context.store.records().texts(table.id, request.role(), column->slug, "column");
    if (!cells) return tl::unexpected(cells.error());
    std::vector<std::string> values;
    for (KeyText& cell : *cells) values.push_back(std::move(cell.text));
    with_value = values.size();
    for (const TextClass& found : classify(values)) {
      if (list.size() == static_cast<std::size_t>(count)) break;
      list.push_back({{"value", found.value}, {"records", found.count}});
      classified += found.count;
    }
  } else {
    if (column->kind != ColumnKind::integer && column->kind != ColumnKind::numeric)
      return fail(ErrorCode::invalid, "Column without numbers",
                  "'" + column->name + "' contains no numbers. Use the method unique.", "method");
    Expression number;
    number.op = Expression::Op::column;
    number.path = {column->slug};
    auto cells =
        context.store.records().numbers(table.id, request.role(), number, std::nullopt, "column");
    if (!cells) return tl::unexpected(cells.error());
    std::vector<double> values;
    for (const KeyNumber& cell : *cells) values.push_back(cell.number);
    with_value = classified = values.size();
    for (const NumberClass& found :
         classify(values, method == "equal" ? ClassMethod::equal : ClassMethod::quantile, count))
      list.push_back({{"from", found.from}, {"to", found.to}, {"records", found.count}});
  }
  const auto records = static_cast<std::uint64_t>(table.records);
  return json_response({{"total", list.size()},
                        {"classes", std::move(list)},
                        {"records", records},
                        {"unclassified", with_value - classified},
                        {"without", records - std::min(records, with_value)}});
}

Result<Response> history(const RouteContext& context, const Request& request) {
  auto page = STRATA_TRY(page_of(request));
  auto table = STRATA_TRY(stored_table(context, request));
  std::optional<std::int64_t> key;
  if (const std::string text = request.query_or("key", {}); !text.empty()) {
    auto number = STRATA_TRY(parse_integer(text, 0, kMaxRecordKey, "key"));
    key = number;
  }
  const auto before = STRATA_TRY(number_after(page, INT64_MAX));
  auto rows = STRATA_TRY(context.store.tables().history(table.id, request.role(), key,
                                                        page.limit + 1, page.offset, before));
  const auto last =
      end_page(rows.rows, page, [](const auto& row) { return ListPlace::array({row.sequence}); });
  nlohmann::json list = nlohmann::json::array();
  for (const auto& row : rows.rows) list.push_back(to_json(row));
  Response response = json_response({{"edits", std::move(list)}, {"total", rows.total}});
  add_page_links(response, request, page, last);
  return response;
}

Result<Response> undo(const RouteContext& context, const Request& request, bool redo) {
  if (!request.body.empty()) STRATA_TRY(body_of<protocol::Empty>(request));
  auto table = STRATA_TRY(stored_table(context, request));
  auto plan = STRATA_TRY(context.store.tables().plan_undo(table.id, request.user(), redo));
  if (!plan.vanishing.empty()) {
    auto painted = STRATA_TRY(app::painted_layers(context, table.id, request.role()));
    if (const std::string where = app::where_painted(painted, plan.vanishing); !where.empty())
      return fail(ErrorCode::conflict, "Record has painted texels",
                  "This would delete records that have painted texels: " + where +
                      ". Delete these records instead, and choose what happens to their texels.");
  }
  const auto answer = [](const TableChange& done) {
    return json_response({{"sequence", done.sequence},
                          {"created", done.created},
                          {"changed", done.changed},
                          {"deleted", done.deleted},
                          {"columns_changed", done.columns_changed}});
  };
  auto done =
      STRATA_TRY(context.store.tables().undo(table.id, request.user(), redo, plan.table_sequence,
                                             idempotent_response<TableChange>(request, answer)));
  context.changes.records_changed(done, request.user());
  return answer(done);
}

// --- areas of the table's keys

Result<Response> areas(const RouteContext& context, const Request& request) {
  auto table = STRATA_TRY(stored_table(context, request));
  auto painted = STRATA_TRY(app::painted_layers(context, table.id, request.role()));
  struct Sum {
    CompensatedSum area_m2;
    std::map<ModelId, std::pair<CompensatedSum, nlohmann::json>> models;
  };
  std::map<std::int64_t, Sum> sums;
  for (const app::PaintedLayer& layer : painted)
    for (const auto& [key, area] : layer.areas) {
      Sum& sum = sums[key];
      sum.area_m2 += area.area_m2;
      auto& [model_area_m2, layers] = sum.models[layer.layer.model_id];
      model_area_m2 += area.area_m2;
      layers.push_back(
          {{"layer", layer.layer.id}, {"area_m2", area.area_m2}, {"texels", area.texels}});
    }
  std::vector<std::int64_t> keys;
  for (const auto& [key, sum] : sums) keys.push_back(key);
  auto missing = STRATA_TRY(context.store.records().missing(table.id, keys));
  nlohmann::json list = nlohmann::json::array();
  for (auto& [key, sum] : sums) {
    nlohmann::json models = nlohmann::json::array();
    for (auto& [model, of_model] : sum.models)
      models.push_back({{"model", model},
                        {"area_m2", of_model.first.value()},
                        {"layers", std::move(of_model.second)}});
    list.push_back({{"key", key},
                    {"area_m2", sum.area_m2.value()},
                    {"has_record", !std::binary_search(missing.begin(), missing.end(), key)},
                    {"models", std::move(models)}});
  }
  const std::size_t total = list.size();
  return json_response({{"areas", std::move(list)}, {"total", total}});
}

}  // namespace

void add_table_routes(Router& router, const RouteContext& context) {
  const std::string tables = "/api/v1/projects/{project}/tables", table = "/api/v1/tables/{table}";
  using Answer = Result<Response> (*)(const RouteContext&, const Request&);
  const auto read = [&](const std::string& pattern, Answer answer,
                        std::vector<std::string> query = {}, StateOf state = {}) {
    router.add({.method = Method::get,
                .pattern = pattern,
                .handler = answering([&context, answer](const Request& request) {
                  return answer(context, request);
                }),
                .query = std::move(query),
                .state = std::move(state)});
  };
  const auto write = [&](Method method, const std::string& pattern, Answer answer,
                         BodyKind body = BodyKind::memory) {
    router.add({.method = method,
                .pattern = pattern,
                .handler = answering([&context, answer](const Request& request) {
                  return answer(context, request);
                }),
                .role = Role::curator,
                .body = body,
                .max_body = body == BodyKind::none ? 0 : context.options.max_json_bytes,
                .keeps_answer = true,
                .needs_version = method != Method::post});
  };
  read(tables, list_tables, {"limit", "offset", "after"});
  write(Method::post, tables, create_table);
  read(table, [](const RouteContext& c, const Request& request) -> Result<Response> {
    auto found = STRATA_TRY(stored_table(c, request));
    return with_etag(json_response(to_json(found)), request, found.version);
  });
  write(Method::patch, table, change_table);
  write(Method::remove, table, delete_table, BodyKind::none);
  read(table + "/columns", list_columns, {"limit", "offset", "after"});
  write(Method::post, table + "/columns", create_column);
  write(Method::patch, table + "/columns/{column}", change_column);
  write(Method::remove, table + "/columns/{column}", drop_column, BodyKind::none);
  read(table + "/columns/{column}/cycles", cycles, {}, state_of_records(context));
  read(table + "/columns/{column}/classes", classes, {"method", "count"},
       state_of_records(context));
  read(table + "/edits", history, {"key", "limit", "offset", "after"});
  read(table + "/areas", areas, {}, state_of_painted_table(context));
  for (const bool redo : {false, true})
    router.add({.method = Method::post,
                .pattern = table + (redo ? "/redo" : "/undo"),
                .handler = answering([&context, redo](const Request& request) {
                  return undo(context, request, redo);
                }),
                .role = Role::annotator,
                .body = BodyKind::memory,
                .max_body = context.options.max_json_bytes,
                .keeps_answer = true});
}

}  // namespace strata::net
