#include <algorithm>
#include <map>

#include "app/change_notifier.h"
#include "app/records/painted_keys.h"
#include "app/records/readable_area.h"
#include "app/records/record_csv.h"
#include "app/records/record_measures.h"
#include "app/records/workbook.h"
#include "domain/people/role.h"
#include "domain/tables/table.h"
#include "expression/expression_parser.h"
#include "net/api/route_help.h"
#include "net/api/routes.h"
#include "net/http/idempotency_store.h"
#include "net/http/page.h"
#include "net/serialization/record_place.h"
#include "net/serialization/sheet_response.h"
#include "net/serialization/table_serialization.h"
#include "net/transport/server_options.h"
#include "room/rooms.h"
#include "store/store.h"
#include "store/tables/records.h"
#include "store/tables/table_changes.h"

namespace strata::net {
namespace {

using TableChange = store::TableChange;

constexpr std::uint64_t kMaxRecordsBytes = 64u << 20;

constexpr std::size_t kMaxSortColumns = 16;

// Parses the sort order, such as "name,-depth". A minus means descending. A repeated column has no
// effect.
Result<std::vector<std::pair<std::string, bool>>> order_of(const std::string& text) {
  std::vector<std::pair<std::string, bool>> order;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    std::string word = text.substr(begin, end - begin);
    const bool descending = word.starts_with('-');
    // A plus in a query is decoded as a space.
    if (descending || word.starts_with('+') || word.starts_with(' ')) word.erase(0, 1);
    if (!word.empty() &&
        std::ranges::find(order, word, &std::pair<std::string, bool>::first) == order.end())
      order.emplace_back(std::move(word), descending);
    if (order.size() > kMaxSortColumns)
      return fail(
          ErrorCode::invalid, "Too many sort columns",
          "Records can be sorted by at most " + std::to_string(kMaxSortColumns) + " columns.",
          "sortby");
    begin = end + 1;
  }
  return order;
}

// Sorts by a measure, such as the area on the layer. The database sorts by all other columns.
Result<store::RecordPage> page_by_measure(const RouteContext& context,
                                          const app::RecordPlace& place,
                                          const app::RecordMeasures& measures, std::size_t measure,
                                          Role seen_by, store::RecordQuery query) {
  const bool descending = query.order.front().second;
  const auto limit = static_cast<std::size_t>(query.limit),
             offset = static_cast<std::size_t>(query.offset);
  const auto after = std::exchange(query.after, std::nullopt);
  query.order.erase(query.order.begin());
  query.limit = store::kMaxRecords;
  query.offset = 0;
  auto page = STRATA_TRY(context.store.records().page(place.table.id, seen_by, query));
  // Computes each value only once because a line may have thousands of vertices.
  std::vector<std::pair<double, Record>> by_value;
  by_value.reserve(page.records.size());
  for (Record& record : page.records) {
    const double value = measures.of(record)[measure];
    by_value.emplace_back(value, std::move(record));
  }
  const auto comes_before = [descending](double a, double b) { return descending ? a > b : a < b; };
  std::ranges::stable_sort(by_value, comes_before, &std::pair<double, Record>::first);
  auto begin = by_value.begin() + static_cast<std::ptrdiff_t>(std::min(offset, by_value.size()));
  if (after) {
    if (after->size() != 2 || !after->at(0).is_number() || !after->at(1).is_number_integer())
      return wrong_place();
    const auto value = after->at(0).get<double>();
    const auto key = after->at(1).get<std::int64_t>();
    const auto [low, high] =
        std::ranges::equal_range(by_value, value, comes_before, &std::pair<double, Record>::first);
    const auto same =
        std::find_if(low, high, [key](const auto& each) { return each.second.key == key; });
    // If that record is deleted, continues with the next record that has the same value and a
    // higher key. Records with equal values are sorted by key unless the request sorts by more
    // columns.
    begin = same != high ? same + 1 : std::find_if(low, high, [key](const auto& each) {
      return each.second.key > key;
    });
  }
  const auto end =
      begin + static_cast<std::ptrdiff_t>(std::min<std::size_t>(limit, by_value.end() - begin));
  auto& records = page.records;
  records.clear();
  page.last.reset();
  if (end != by_value.end() && end != begin)
    page.last = ListPlace::array({(end - 1)->first, (end - 1)->second.key});
  for (; begin != end; ++begin) records.push_back(std::move(begin->second));
  return page;
}

// Returns a workbook with the columns of `records_csv` and typed values. For a layer, the last
// column contains areas in a readable unit.
Result<Response> records_book(const RouteContext& context, const store::RecordPage& page,
                              const app::RecordMeasures& measures,
                              const app::WordsOfTables& words) {
  std::vector<app::BookColumn> heads{{"key", {}}};
  for (const Column& column : page.table.columns) heads.push_back({column.slug, {}});
  for (const std::string& name : measures.names()) heads.push_back({name, {}});
  const bool has_area = std::ranges::count(measures.names(), app::kAreaMeasure) > 0;
  double largest_m2 = 0;
  for (const Record& record : page.records)
    largest_m2 = std::max(largest_m2, measures.area_m2(record.key));
  const app::AreaUnit unit = app::readable_area(largest_m2);
  if (has_area) {
    std::ranges::find(heads, app::kAreaMeasure, &app::BookColumn::head)->number_format =
        app::number_format(largest_m2);
    heads.push_back({app::readable_head(app::kAreaMeasure, unit),
                     app::number_format(largest_m2 * unit.per_m2)});
  }
  app::Workbook book(context.options.upload_dir, page.table.slug, heads);
  std::vector<app::BookCell> cells;
  for (const Record& record : page.records) {
    cells.assign(1, double(record.key));
    for (const Column& column : page.table.columns) {
      if (auto word = app::term_word(record, column, words))
        cells.emplace_back(std::move(*word));
      else
        cells.push_back(app::book_cell(record, column));
    }
    for (const double value : measures.of(record)) cells.emplace_back(value);
    if (has_area) cells.emplace_back(measures.area_m2(record.key) * unit.per_m2);
    book.add_row(cells);
  }
  return file_response(STRATA_TRY(book.finish(page.table.slug + ".xlsx")));
}

Result<Response> list_records(const RouteContext& context, const Request& request) {
  auto page = STRATA_TRY(page_of(request));
  const auto format = STRATA_TRY(sheet_format(request));
  auto separator = STRATA_TRY(csv_separator(request));
  auto place = STRATA_TRY(record_place(context, request));
  store::RecordQuery query;
  auto order = STRATA_TRY(order_of(request.query_or("sortby", {})));
  query.order = std::move(order);
  const auto language = STRATA_TRY(requested_language(request));
  query.language = language;
  const std::string terms = request.query_or("terms", "words");
  if (terms != "words" && terms != "keys")
    return fail(ErrorCode::invalid, "Unknown choice", "`terms` must be words or keys.", "terms");
  if (auto filter = request.query.find("filter");
      filter != request.query.end() && !filter->second.empty()) {
    auto condition = query::parse_condition(filter->second, "filter", query::Names::columns);
    if (!condition) return tl::unexpected(condition.error());
    query.filter = std::move(*condition);
  }
  // A table for another program contains all records unless the request limits it.
  const bool whole = format != SheetFormat::json && !request.query.contains("limit");
  query.limit = whole ? store::kMaxRecords : page.limit;
  query.offset = page.offset;
  query.after = page.after;
  if (auto at = request.query.find("at"); at != request.query.end()) {
    auto sequence = STRATA_TRY(sequence_at(context.store, place.table, at->second));
    query.at = sequence;
  }
  // Uses the current columns. A column that no longer contains lines has no length.
  auto measures = STRATA_TRY(app::RecordMeasures::of_place(context, place, place.table.columns));
  const auto& names = measures.names();
  const auto measure =
      query.order.empty() ? names.end() : std::ranges::find(names, query.order.front().first);
  auto records = STRATA_TRY(
      measure == names.end() ? context.store.records().page(place.table.id, request.role(), query)
                             : page_by_measure(context, place, measures,
                                               static_cast<std::size_t>(measure - names.begin()),
                                               request.role(), query));
  app::WordsOfTables words;
  if (format != SheetFormat::json && terms == "words") {
    auto known =
        STRATA_TRY(app::words_of(context.store, records.table.columns, request.role(), language));
    words = std::move(known);
  }
  if (page.after && records.last && !cursor_of(request, *records.last))
    return fail(ErrorCode::invalid, "Sort values too long",
                "The link to the next page contains the sort values of the last record, and these "
                "are too long for a URL. Sort by fewer columns.",
                "sortby");
  Response response;
  switch (format) {
    case SheetFormat::xlsx:
      response = STRATA_TRY(records_book(context, records, measures, words));
      break;
    case SheetFormat::csv: {
      std::vector<std::vector<double>> values;
      for (const Record& record : records.records) values.push_back(measures.of(record));
      response =
          text_response(app::records_csv(records.records, records.table.columns,
                                         {measures.names(), std::move(values)}, separator, words),
                        kCsvType);
      name_download(response, place.table.slug + ".csv");
      break;
    }
    case SheetFormat::json: {
      nlohmann::json list = nlohmann::json::array();
      for (const Record& record : records.records) {
        nlohmann::json json = to_json(record, records.table.columns);
        app::add_measures(json, measures.names(), measures.of(record));
        list.push_back(std::move(json));
      }
      response = json_response({{"records", std::move(list)}, {"total", records.total}});
    }
  }
  if (!whole) add_page_links(response, request, page, records.last);
  response.with("Strata-Sequence", std::to_string(records.table.sequence)).with("Vary", "Accept");
  return response;
}

Result<Response> read_record(const RouteContext& context, const Request& request) {
  auto key = STRATA_TRY(record_key(request));
  auto place = STRATA_TRY(record_place(context, request));
  std::optional<std::int64_t> at;
  if (auto text = request.query.find("at"); text != request.query.end()) {
    auto sequence = STRATA_TRY(sequence_at(context.store, place.table, text->second));
    at = sequence;
  }
  Table then;
  auto record = STRATA_TRY(stored_record(context, place.table, request.role(), key, at, &then));
  nlohmann::json json = to_json(record, then.columns);
  const auto measures = STRATA_TRY(app::RecordMeasures::of_place(context, place, then.columns));
  app::add_measures(json, measures.names(), measures.of(record));
  if (!place.layer) return with_etag(json_response(json), request, record.version);
  return json_response(json).with("ETag", etag_of(record.version));
}

// --- changes

Error first_problem(const TableChange& change, bool is_list) {
  Error problem = change.problems.front().problem;
  if (is_list && change.problems.front().index)
    problem.field =
        "records[" + std::to_string(*change.problems.front().index) + "]." + problem.field;
  return problem;
}

Result<Response> create_from_json(const RouteContext& context, const Request& request,
                                  const app::RecordPlace& place) {
  auto body = STRATA_TRY(body_of<protocol::RecordsCreate>(request, kMaxRecordsBytes));
  if (body.records && (body.key || body.values))
    return fail(ErrorCode::invalid, "Too many parameters",
                "Send either `records`, or the `key` and `values` of a single record.", "records");
  store::WriteRecords write;
  write.may_change = false;
  const bool is_list = body.records.has_value();
  std::vector<protocol::RecordInput> inputs;
  if (is_list)
    inputs = std::move(*body.records);
  else
    inputs.push_back({body.key, body.values});
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const std::string field = is_list ? "records[" + std::to_string(i) + "].values" : "values";
    auto values =
        values_by_column(place.table, inputs[i].values.value_or(nlohmann::json::object()), field);
    if (!values) return tl::unexpected(values.error());
    write.records.push_back({inputs[i].key, std::move(*values)});
  }
  const auto answer = [is_list, role = request.role()](const TableChange& change) {
    const Table seen = seen_by(change.table, role);
    if (!is_list) {
      const Record& record = change.records.front();
      return json_response(to_json(record, seen.columns), 201)
          .with("Location",
                "/api/v1/tables/" + change.table.slug + "/records/" + std::to_string(record.key))
          .with("ETag", etag_of(record.version));
    }
    nlohmann::json list = nlohmann::json::array();
    for (const Record& record : change.records) list.push_back(to_json(record, seen.columns));
    const std::size_t total = list.size();
    return json_response({{"records", std::move(list)}, {"total", total}}, 201);
  };
  auto change = STRATA_TRY(context.store.records().write(
      place.table.id, write, request.user(), idempotent_response<TableChange>(request, answer)));
  if (!change.problems.empty()) return tl::unexpected(first_problem(change, is_list));
  context.changes.records_changed(change, request.user());
  return answer(change);
}

nlohmann::json report_of(const app::RecordRows& rows, const TableChange& change, bool dry_run) {
  nlohmann::json problems = nlohmann::json::array();
  const auto add = [&](int line, const std::string& column, const Error& problem) {
    if (problems.size() == store::kMaxRowProblems) return;
    problems.push_back({{"line", line}, {"title", problem.title}, {"detail", problem.detail}});
    if (!column.empty()) problems.back()["column"] = column;
  };
  for (const app::RowMistake& mistake : rows.mistakes)
    add(mistake.line, mistake.column, mistake.problem);
  for (const store::RowError& problem : change.problems) {
    std::string head = problem.problem.field;
    for (const Column& column : change.table.columns)
      if ("values." + column.slug == head) {
        const auto found = rows.heads.find(column.id);
        head = found == rows.heads.end() ? column.name : found->second;
      }
    // Reports line 1 for a problem in a record of another table, which has no line in the text.
    add(problem.index ? rows.lines[*problem.index] : 1, head, problem.problem);
  }
  const bool refused = !problems.empty();
  const std::size_t created = refused ? 0 : change.created.size(),
                    changed = refused ? 0 : change.changed.size();
  return {{"rows", rows.rows},
          {"created", created},
          {"changed", changed},
          {"unchanged", refused ? 0 : rows.records.size() - created - changed},
          {"dry_run", dry_run},
          {"sequence", refused || dry_run ? 0 : change.sequence},
          {"problems", std::move(problems)}};
}

Result<Response> import_csv(const RouteContext& context, const Request& request,
                            const app::RecordPlace& place) {
  const std::string tried = request.query_or("dry_run", "false");
  if (tried != "true" && tried != "false")
    return fail(ErrorCode::invalid, "Invalid value", "`dry_run` must be true or false.", "dry_run");
  const auto words =
      STRATA_TRY(app::words_of(context.store, place.table.columns, request.role(), {}));
  auto rows = STRATA_TRY(app::read_records_csv(request.body, place.table, words));
  store::WriteRecords write;
  write.records = rows.records;
  write.op = "import";
  // Checks the other rows even if a row cannot be parsed, so one check finds all mistakes.
  write.dry_run = tried == "true" || !rows.mistakes.empty();
  const auto answer = [&rows](const TableChange& change) {
    return json_response(report_of(rows, change, false));
  };
  auto change = STRATA_TRY(context.store.records().write(
      place.table.id, write, request.user(), idempotent_response<TableChange>(request, answer)));
  const bool refused = !rows.mistakes.empty() || !change.problems.empty();
  if (tried == "true") return json_response(report_of(rows, change, true));
  if (refused) {
    const nlohmann::json report = report_of(rows, change, false);
    const auto& first = report.at("problems").front();
    Response response = problem_response({ErrorCode::invalid, "Rows rejected",
                                          "Nothing was written. Line " +
                                              std::to_string(first.at("line").get<int>()) + ": " +
                                              first.at("detail").get<std::string>(),
                                          "body"});
    auto body = nlohmann::json::parse(response.body);
    body["rows"] = report;
    response.body = body.dump();
    return response;
  }
  context.changes.records_changed(change, request.user());
  return answer(change);
}

Result<Response> create_records(const RouteContext& context, const Request& request) {
  auto place = STRATA_TRY(record_place(context, request));
  if (to_lower(request.header("content-type")).starts_with("text/csv"))
    return import_csv(context, request, place);
  if (request.query.contains("dry_run"))
    return fail(ErrorCode::invalid, "Dry run not supported",
                "You can use `dry_run` only with records in text/csv.", "dry_run");
  return create_from_json(context, request, place);
}

Result<Response> change_record(const RouteContext& context, const Request& request) {
  auto key = STRATA_TRY(record_key(request));
  auto body = STRATA_TRY(body_of<protocol::RecordPatch>(request));
  auto place = STRATA_TRY(record_place(context, request));
  auto version = STRATA_TRY(expected_record_version(context, request, place.table, key));
  auto values = STRATA_TRY(values_by_column(place.table, body.values, "values"));
  store::WriteRecords write;
  write.may_create = false;
  write.records.push_back({key, std::move(values), version ? version : body.version});
  const auto answer = [role = request.role()](const TableChange& change) {
    const Record& record = change.records.front();
    return json_response(to_json(record, seen_by(change.table, role).columns))
        .with("ETag", etag_of(record.version));
  };
  // A record without changes adds no entry to the journal, and `change` does not contain it.
  std::optional<Record> same;
  if (auto now = stored_record(context, place.table, request.role(), key, {}))
    same = std::move(*now);
  const auto keep = [&](const TableChange& change) {
    if (!change.records.empty() || !same) return answer(change);
    return json_response(to_json(*same, seen_by(change.table, request.role()).columns))
        .with("ETag", etag_of(same->version));
  };
  auto change = STRATA_TRY(context.store.records().write(
      place.table.id, write, request.user(), idempotent_response<TableChange>(request, keep)));
  if (!change.problems.empty()) return tl::unexpected(first_problem(change, false));
  context.changes.records_changed(change, request.user());
  return keep(change);
}

// Call it when no edit can paint the key anymore.
Result<Response> delete_retired(const RouteContext& context, const Request& request,
                                const Table& table, std::int64_t key,
                                std::optional<std::int64_t> version, const std::string& texels,
                                std::optional<std::int64_t> to) {
  auto painted = STRATA_TRY(app::painted_layers(context, table.id, request.role()));
  const std::string where = app::where_painted(painted, {key});
  if (!where.empty() && texels == "refuse")
    return fail(
        ErrorCode::conflict, "Record has painted texels",
        "Record " + std::to_string(key) + " covers " + where +
            ". Choose what happens to these texels: texels=clear, or texels=reassign&to=KEY.",
        "texels");
  STRATA_TRY(app::repaint_key(context, painted, key, to, request.author()));
  const auto answer = [](const TableChange&) { return empty_response(204); };
  auto change =
      STRATA_TRY(context.store.records().remove(table.id, key, version, request.user(), false,
                                                idempotent_response<TableChange>(request, answer)));
  context.changes.records_changed(change, request.user());
  return answer(change);
}

Result<Response> delete_record(const RouteContext& context, const Request& request) {
  auto key = STRATA_TRY(record_key(request));
  const std::string texels = request.query_or("texels", "refuse");
  if (texels != "refuse" && texels != "clear" && texels != "reassign")
    return fail(ErrorCode::invalid, "Unknown choice", "`texels` must be refuse, clear or reassign.",
                "texels");
  std::optional<std::int64_t> to;
  if ((texels == "reassign") != request.query.contains("to"))
    return fail(ErrorCode::invalid, "Record not specified",
                "texels=reassign requires `to`, the key that replaces the old key in the texels.",
                "to");
  auto place = STRATA_TRY(record_place(context, request));
  const Table& table = place.table;
  if (texels == "reassign") {
    auto number = STRATA_TRY(parse_integer(request.query.at("to"), 0, kMaxRecordKey, "to"));
    auto missing = STRATA_TRY(context.store.records().missing(table.id, std::vector{number}));
    if (!missing.empty() || number == key)
      return fail(ErrorCode::invalid, "Record not found",
                  "`to` must be another record of " + table.name + ".", "to");
    to = number;
  }
  auto version = STRATA_TRY(expected_record_version(context, request, table, key));
  // Checks that the record can be deleted before any texel is changed.
  STRATA_TRY(context.store.records().remove(table.id, key, version, request.user(), true));
  // A stroke that began before the deletion must not paint the key afterwards.
  const auto retired = context.rooms.retire_keys(table.id, std::span(&key, 1));
  auto deleted = retired ? delete_retired(context, request, table, key, version, texels, to)
                         : Result<Response>(tl::unexpected(retired.error()));
  if (!deleted)
    if (const auto missing = context.store.records().missing(table.id, std::vector{key});
        missing && missing->empty())
      context.rooms.admit_keys(table.id, std::vector{key});
  return deleted;
}

}  // namespace

void add_record_routes(Router& router, const RouteContext& context) {
  using Answer = Result<Response> (*)(const RouteContext&, const Request&);
  const auto add = [&](Method method, const std::string& pattern, Answer answer,
                       std::vector<std::string> query, BodyKind body = BodyKind::none,
                       std::uint64_t max_body = 0, StateOf state = {}) {
    const bool changes = method != Method::get;
    router.add({.method = method,
                .pattern = pattern,
                .handler = answering([&context, answer](const Request& request) {
                  return answer(context, request);
                }),
                .role = changes ? Role::annotator : Role::viewer,
                .query = std::move(query),
                .body = body,
                .max_body = max_body,
                .keeps_answer = changes,
                .needs_version = method == Method::patch || method == Method::remove,
                .state = std::move(state)});
  };
  for (const std::string parent :
       {"/api/v1/tables/{table}", "/api/v1/models/{model}/layers/{layer}"}) {
    const std::string records = parent + "/records", record = records + "/{key}";
    add(Method::get, records, list_records,
        {"f", "separator", "filter", "sortby", "lang", "terms", "limit", "offset", "after", "at"},
        BodyKind::none, 0, state_of_records(context));
    add(Method::post, records, create_records, {"dry_run"}, BodyKind::memory, kMaxRecordsBytes);
    add(Method::get, record, read_record, {"at"});
    add(Method::patch, record, change_record, {}, BodyKind::memory, context.options.max_json_bytes);
    add(Method::remove, record, delete_record, {"texels", "to"});
  }
}

}  // namespace strata::net
