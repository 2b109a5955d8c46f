// The audit log.
#include <algorithm>

#include "core/text/bytes.h"
#include "net/api/route_help.h"
#include "net/api/routes.h"
#include "net/http/page.h"
#include "net/serialization/audit_serialization.h"
#include "net/transport/server_options.h"
#include "store/content/projects.h"
#include "store/people/audit.h"
#include "store/store.h"

namespace strata::net {
namespace {

using store::AuditQuery;
using store::AuditRow;

constexpr const char* kLinesType = "application/x-ndjson";
constexpr int kRowsAtOnce = 500;
constexpr std::size_t kMaxText = 255;

Result<bool> wants_lines(const Request& request) {
  const auto format = request.query.find("f");
  if (format == request.query.end())
    return request.header("accept").find(kLinesType) != std::string_view::npos;
  if (format->second == "json") return false;
  if (format->second == "jsonl") return true;
  return fail(ErrorCode::not_acceptable, "Unknown format", "`f` must be json or jsonl.", "f");
}

Result<std::string> text_of(const Request& request, const std::string& name) {
  std::string text = request.query_or(name, {});
  if (text.size() > kMaxText)
    return fail(ErrorCode::invalid, "Text too long",
                "`" + name + "` can have at most " + std::to_string(kMaxText) + " bytes.", name);
  return text;
}

Result<AuditQuery> query_of(const RouteContext& context, const Request& request) {
  AuditQuery query;
  query.actor = STRATA_TRY(text_of(request, "actor"));
  query.action = STRATA_TRY(text_of(request, "action"));
  query.subject_kind = STRATA_TRY(text_of(request, "subject_kind"));
  query.from = STRATA_TRY(time_of(request, "from"));
  query.to = STRATA_TRY(time_of(request, "to"));
  if (!query.action.empty() &&
      std::ranges::find(store::kAuditActions, query.action) == store::kAuditActions.end())
    return fail(ErrorCode::invalid, "Unknown action",
                "The audit log has no action `" + query.action.substr(0, 100) +
                    "`. See the list of actions at /api/v1/docs.",
                "action");
  if (const auto ref = request.query.find("project"); ref != request.query.end()) {
    const auto project = context.store.projects().find(ref->second);
    if (!project && project.error().code != ErrorCode::not_found)
      return tl::unexpected(project.error());
    if (!project)
      return fail(ErrorCode::invalid, "Project not found",
                  "There is no project `" + ref->second.substr(0, 100) + "`.", "project");
    query.project = project->id;
  }
  return query;
}

// Reads the rows in pieces, so that the log can be of any size and a slow client holds no
// connection to the database.
bool write_lines(store::Store& store, AuditQuery query, const Response::Sink& sink) {
  query.limit = kRowsAtOnce;
  for (;;) {
    const auto rows = store.audit().rows(query);
    if (!rows) return false;
    std::string text;
    for (const AuditRow& row : *rows) text += json_line(row);
    if (!text.empty() && !sink(bytes_of(text))) return false;
    if (rows->size() < kRowsAtOnce) return true;
    query.before = rows->back().id;
  }
}

Result<Response> list_audit(const RouteContext& context, const Request& request) {
  auto query = STRATA_TRY(query_of(context, request));
  const auto lines = STRATA_TRY(wants_lines(request));
  if (lines) {
    for (const char* name : {"limit", "after"})
      if (request.query.contains(name))
        return fail(ErrorCode::invalid, "Not for JSON lines",
                    "JSON lines contain all rows, so `limit` and `after` are only for `f=json`.",
                    name);
    Response response;
    response.with("Content-Type", kLinesType).with("Cache-Control", "private, no-store");
    name_download(response, "audit.jsonl");
    response.stream =
        Response::Stream{{}, [&store = context.store, query](const Response::Sink& sink) {
                           return write_lines(store, query, sink);
                         }};
    return response;
  }
  const auto page = STRATA_TRY(page_of(request));
  query.limit = page.limit + 1;
  query.before = STRATA_TRY(number_after(page, std::numeric_limits<std::int64_t>::max()));
  auto rows = STRATA_TRY(context.store.audit().rows(query));
  const auto last =
      end_page(rows, page, [](const AuditRow& row) { return ListPlace::array({row.id}); });
  nlohmann::json entries = nlohmann::json::array();
  for (const AuditRow& row : rows) entries.push_back(to_json(row));
  Response response =
      json_response({{"entries", std::move(entries)}, {"days", context.options.audit_days}});
  add_page_links(response, request, page, last);
  return response;
}

}  // namespace

void add_audit_routes(Router& router, const RouteContext& context) {
  router.add({.method = Method::get,
              .pattern = "/api/v1/audit",
              .handler = answering(
                  [&context](const Request& request) { return list_audit(context, request); }),
              .role = Role::administrator,
              .query = {"actor", "action", "subject_kind", "from", "to", "project", "f", "limit",
                        "after"}});
}

}  // namespace strata::net
