#include <algorithm>

#include "app/change_notifier.h"
#include "domain/people/role.h"
#include "domain/tables/term.h"
#include "domain/tables/term_list.h"
#include "net/api/addressed.h"
#include "net/api/route_help.h"
#include "net/api/routes.h"
#include "net/http/idempotency_store.h"
#include "net/http/page.h"
#include "net/live/live_sockets.h"
#include "net/live/table_events.h"
#include "net/serialization/sheet_response.h"
#include "store/store.h"
#include "store/tables/records.h"
#include "store/tables/table_changes.h"
#include "store/tables/tables.h"
#include "vocabulary/terms_csv.h"
#include "vocabulary/terms_skos.h"

namespace strata::net {
namespace {

using TableChange = store::TableChange;

constexpr std::uint64_t kMaxTermsBytes = 32u << 20;
constexpr std::size_t kMaxListNameLength = 200;

// The Content-Type selects the format.
Result<TermList> read_terms(const Request& request) {
  const std::string type = to_lower(request.header("content-type"));
  const std::string kind = type.substr(0, std::min(type.find_first_of("; "), type.size()));
  if (kind == "text/csv") return read_terms_csv(request.body);
  if (kind == "text/turtle") return read_terms_skos(request.body, RdfSyntax::turtle);
  if (kind == "application/rdf+xml") return read_terms_skos(request.body, RdfSyntax::rdf_xml);
  return fail(ErrorCode::unsupported, "Unknown format",
              "Send terms as text/csv, text/turtle or application/rdf+xml.", "Content-Type");
}

Result<bool> is_dry_run(const Request& request) {
  const std::string tried = request.query_or("dry_run", "false");
  if (tried == "true" || tried == "false") return tried == "true";
  return fail(ErrorCode::invalid, "Invalid value", "`dry_run` must be true or false.", "dry_run");
}

nlohmann::json report_of(const TermList& list, const TableChange& change, bool dry_run) {
  nlohmann::json problems = nlohmann::json::array();
  const auto add = [&](int line, const std::string& code, const std::string& column,
                       const Error& problem) {
    if (problems.size() == store::kMaxRowProblems) return;
    problems.push_back({{"line", line}, {"title", problem.title}, {"detail", problem.detail}});
    if (!code.empty()) problems.back()["code"] = code;
    if (!column.empty()) problems.back()["column"] = column;
  };
  for (const TermMistake& mistake : list.mistakes)
    add(mistake.line, mistake.code, mistake.column, mistake.problem);
  for (const store::RowError& problem : change.problems) {
    const Term* term = problem.index ? &list.terms[*problem.index] : nullptr;
    constexpr std::string_view kValues = "values.";
    const std::string& field = problem.problem.field;
    add(term ? term->line : 0, term ? term->code : std::string(),
        field.starts_with(kValues) ? field.substr(kValues.size()) : field, problem.problem);
  }
  const bool refused = !problems.empty();
  const std::size_t created = refused ? 0 : change.created.size(),
                    changed = refused ? 0 : change.changed.size();
  nlohmann::json report{{"rows", list.rows},
                        {"created", created},
                        {"changed", changed},
                        {"unchanged", refused ? 0 : list.terms.size() - created - changed},
                        {"dry_run", dry_run},
                        {"sequence", refused || dry_run ? 0 : change.sequence},
                        {"left_out", list.left_out},
                        {"problems", std::move(problems)}};
  if (!refused && !dry_run) report["table"] = to_json(change.table);
  return report;
}

Result<Response> refusal(const TermList& list, const TableChange& change) {
  const nlohmann::json report = report_of(list, change, false);
  const auto& first = report.at("problems").front();
  const int line = first.at("line").get<int>();
  const std::string where = line > 0 ? "Line " + std::to_string(line) + ": "
                            : first.contains("code")
                                ? "\"" + first.at("code").get<std::string>() + "\": "
                                : std::string();
  Response response = problem_response(
      {ErrorCode::invalid, "Terms rejected",
       "Nothing was written. " + where + first.at("detail").get<std::string>(), "body"});
  auto body = nlohmann::json::parse(response.body);
  body["rows"] = report;
  response.body = body.dump();
  return response;
}

Result<Response> create_terms(const RouteContext& context, const Request& request) {
  auto dry_run = STRATA_TRY(is_dry_run(request));
  store::NewTable new_table;
  new_table.table.name = request.query_or("name", {});
  if (new_table.table.name.empty() || new_table.table.name.size() > kMaxListNameLength)
    return fail(ErrorCode::invalid, "Invalid name",
                "Send the name of the list as `name`. It must be 1 to 200 bytes long.", "name");
  auto slug = STRATA_TRY(slug_of({}, new_table.table.name));
  new_table.table.slug = slug;
  auto project = STRATA_TRY(stored_project(context, request));
  new_table.table.project_id = project.id;
  auto list = STRATA_TRY(read_terms(request));
  std::vector<std::string> languages;
  for (const std::string& column : list.columns)
    if (const auto language = label_language(column)) languages.push_back(*language);
  new_table.table.columns = new_term_columns(languages);
  if (!list.mistakes.empty()) {
    if (dry_run) return json_response(report_of(list, {}, true));
    return refusal(list, {});
  }
  new_table.terms = list;
  const auto answer = [&list](const std::vector<TableChange>& changes) {
    return json_response(report_of(list, changes.front(), false), 201)
        .with("Location", "/api/v1/tables/" + changes.front().table.slug);
  };
  auto changes = context.store.tables().create_several(
      {new_table}, dry_run, request.user(), "import",
      idempotent_response<std::vector<TableChange>>(request, answer));
  if (!changes) return tl::unexpected(changes.error());
  if (dry_run) return json_response(report_of(list, changes->front(), true));
  if (!changes->front().problems.empty()) return refusal(list, changes->front());
  tell_table(context.live_sockets, protocol::TableEventEvent::created, changes->front().table,
             request.user());
  return answer(*changes);
}

Result<Response> import_terms(const RouteContext& context, const Request& request) {
  auto dry_run = STRATA_TRY(is_dry_run(request));
  auto table = STRATA_TRY(stored_table(context, request));
  auto list = STRATA_TRY(read_terms(request));
  if (!list.mistakes.empty()) {
    if (dry_run) return json_response(report_of(list, {}, true));
    return refusal(list, {});
  }
  const auto answer = [&list](const TableChange& change) {
    return json_response(report_of(list, change, false));
  };
  auto change = STRATA_TRY(context.store.tables().import_terms(
      table.id, list, dry_run, request.user(), idempotent_response<TableChange>(request, answer)));
  if (dry_run) return json_response(report_of(list, change, true));
  if (!change.problems.empty()) return refusal(list, change);
  context.changes.records_changed(change, request.user());
  return answer(change);
}

// --- reading

// Marks the terms to list. These are the terms that match the words, and their ancestors.
std::vector<bool> with_those_above(const std::vector<ListedTerm>& terms,
                                   const std::vector<bool>& match) {
  std::map<std::int64_t, std::size_t> places;
  for (std::size_t i = 0; i < terms.size(); ++i) places[terms[i].key] = i;
  std::vector<bool> included = match;
  // Descendants come later in the list. The loop runs from the end, so it marks each term before it
  // visits the parent.
  for (std::size_t i = terms.size(); i-- > 0;)
    if (included[i] && terms[i].depth > 0) included[places.at(*terms[i].parent)] = true;
  return included;
}

Response tree_response(const Request& request, const std::string& language,
                       const std::vector<ListedTerm>& terms, const Page& page) {
  const Palette palette = terms_palette(terms);
  std::map<std::int64_t, int> below;
  for (const ListedTerm& listed : terms)
    if (listed.depth > 0) ++below[*listed.parent];
  const auto match = terms_with(terms, request.query_or("q", {}));
  const auto included = with_those_above(terms, match);
  nlohmann::json list = nlohmann::json::array();
  int total = 0;
  for (std::size_t i = 0; i < terms.size(); ++i) {
    if (!included[i]) continue;
    const int place = total++;
    if (place < page.offset || place >= page.offset + page.limit) continue;
    const ListedTerm& listed = terms[i];
    const Term& term = listed.term;
    list.push_back({{"key", listed.key},
                    {"code", term.code},
                    {"name", label_in(term, language)},
                    {"label", term.label},
                    {"labels", term.labels},
                    {"depth", listed.depth},
                    {"below", below[listed.key]},
                    {"match", static_cast<bool>(match[i])},
                    {"definition", term.definition},
                    {"uri", term.uri},
                    {"color", rgb_text(color_of(palette, static_cast<double>(listed.key)))},
                    {"pattern", term.pattern}});
    if (listed.depth > 0) list.back()["parent"] = *listed.parent;
  }
  Response response = json_response({{"terms", std::move(list)}, {"total", total}});
  add_page_links(response, request, page, total);
  return response;
}

Result<Response> list_terms_of(const RouteContext& context, const Request& request) {
  const std::string format = request.query_or("f", "json");
  if (format != "json" && format != "csv" && format != "turtle")
    return fail(ErrorCode::not_acceptable, "Unknown format", "`f` must be json, csv or turtle.",
                "f");
  auto separator = STRATA_TRY(csv_separator(request));
  auto shown = STRATA_TRY(page_of(request));
  const auto language = STRATA_TRY(requested_language(request));
  auto table = STRATA_TRY(stored_table(context, request));
  if (!term_columns(table))
    return fail(
        ErrorCode::conflict, "Not a term list",
        table.name + " is a table of records, not a term list. Request its `/records` instead.");
  store::RecordQuery all;
  all.limit = store::kMaxRecords;
  auto page = STRATA_TRY(context.store.records().page(table.id, request.role(), all));
  const auto columns = term_columns(page.table);
  if (!columns)
    return fail(ErrorCode::conflict, "Not a term list",
                table.name + " is no longer a term list. Somebody changed it in the meantime.");
  const auto listed = list_terms(*columns, page.records);
  Response response;
  if (format == "json") {
    response = tree_response(request, language, listed, shown);
  } else {
    std::vector<Term> terms;
    for (const ListedTerm& each : listed) terms.push_back(each.term);
    if (format == "csv") {
      response = text_response(terms_csv(terms, separator), kCsvType);
    } else {
      auto text = STRATA_TRY(terms_skos(page.table.name, terms));
      response = text_response(std::move(text), "text/turtle; charset=utf-8");
    }
    name_download(response, page.table.slug + (format == "csv" ? ".csv" : ".ttl"));
  }
  response.with("Strata-Sequence", std::to_string(page.table.sequence));
  return response;
}

}  // namespace

void add_term_routes(Router& router, const RouteContext& context) {
  const auto write = [&](const std::string& pattern,
                         Result<Response> (*answer)(const RouteContext&, const Request&),
                         std::vector<std::string> query) {
    router.add({.method = Method::post,
                .pattern = pattern,
                .handler = answering([&context, answer](const Request& request) {
                  return answer(context, request);
                }),
                .role = Role::curator,
                .query = std::move(query),
                .body = BodyKind::memory,
                .max_body = kMaxTermsBytes,
                .keeps_answer = true});
  };
  write("/api/v1/projects/{project}/terms", create_terms, {"name", "dry_run"});
  write("/api/v1/tables/{table}/terms", import_terms, {"dry_run"});
  router.add({.method = Method::get,
              .pattern = "/api/v1/tables/{table}/terms",
              .handler = answering(
                  [&context](const Request& request) { return list_terms_of(context, request); }),
              .query = {"limit", "offset", "q", "lang", "f", "separator"},
              .state = state_of_records(context)});
}

}  // namespace strata::net
