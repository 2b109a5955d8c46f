// The activity of a project.
#include "domain/people/role.h"
#include "net/api/addressed.h"
#include "net/http/page.h"
#include "net/live/model_events.h"
#include "net/serialization/activity_serialization.h"
#include "net/serialization/people_serialization.h"
#include "store/content/models.h"
#include "store/content/projects.h"
#include "store/people/activity.h"
#include "store/store.h"

namespace strata::net {
namespace {

using store::Activity;

Result<Response> list_activity(const RouteContext& context, const Request& request) {
  const auto page = STRATA_TRY(page_of(request));
  store::ActivityQuery query;
  query.limit = page.limit;
  query.with_members = request.principal->role >= Role::curator;
  if (const auto before = request.query.find("before"); before != request.query.end()) {
    query.before = place_of(before->second);
    if (!query.before)
      return fail(ErrorCode::invalid, "Invalid page",
                  "`before` must be the value of `next` from an earlier response, for example "
                  "1777896570120000-7.",
                  "before");
  }
  const auto project = STRATA_TRY(stored_project(context, request));
  if (const auto ref = request.query.find("model"); ref != request.query.end()) {
    const auto model = context.store.models().find(ref->second);
    if (!model && model.error().code != ErrorCode::not_found) return tl::unexpected(model.error());
    if (!model || model->project_id != project.id)
      return fail(ErrorCode::invalid, "Model not found",
                  "The project has no model `" + ref->second.substr(0, 100) + "`.", "model");
    query.model = model->id;
  }
  const auto found =
      STRATA_TRY(context.store.projects().activity(project.id, request.role(), query));
  nlohmann::json lines = nlohmann::json::array();
  for (const Activity& line : found.lines) lines.push_back(to_json(line));
  nlohmann::json answer{{"activity", std::move(lines)}};
  if (found.next) answer["next"] = to_text(*found.next);
  STRATA_TRY(People::add_to(context.store, answer));
  return json_response(answer);
}

// Streams the events after `Last-Event-ID` or, without this header, from the current time.
Result<Response> listen(const RouteContext& context, const Request& request) {
  const auto model = STRATA_TRY(stored_model(context, request));
  std::optional<store::ActivityPlace> after;
  if (const auto text = request.header("last-event-id"); !text.empty()) {
    after = place_of(text);
    if (!after)
      return fail(ErrorCode::malformed, "Event not found",
                  "`Last-Event-ID` must be the id of an event, for example 1777896570120000-7.",
                  "Last-Event-ID");
  }
  Response response;
  const auto events = std::make_shared<ModelEvents>(context, request, model, after);
  response.events = Response::Events{[events] { return events->next(); }};
  return response;
}

}  // namespace

void add_activity_routes(Router& router, const RouteContext& context) {
  router.add({.method = Method::get,
              .pattern = "/api/v1/projects/{project}/activity",
              .handler = answering(
                  [&context](const Request& request) { return list_activity(context, request); }),
              .query = {"model", "before", "limit"}});
  router.add({.method = Method::get,
              .pattern = "/api/v1/models/{model}/events",
              .handler = answering(
                  [&context](const Request& request) { return listen(context, request); })});
}

}  // namespace strata::net
