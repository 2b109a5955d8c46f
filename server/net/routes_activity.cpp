// What was done in a project.
#include "net/activity_wire.h"
#include "net/model_events.h"
#include "net/people_wire.h"

namespace strata::net {
namespace {

using store::Activity;

Result<Response> list_activity(const RouteContext& context, const Request& request) {
  const auto page = page_of(request);
  if (!page) return tl::unexpected(page.error());
  store::ActivityQuery query;
  query.limit = page->limit;
  query.with_members = request.principal->role >= Role::curator;
  if (const auto before = request.query.find("before"); before != request.query.end()) {
    query.before = place_of(before->second);
    if (!query.before)
      return fail(422, "No such page",
                  "`before` is `next` of an answer: 1777896570120000-7, for example.", "before");
  }
  const auto project = context.store.project(request.param("project"));
  if (!project) return tl::unexpected(project.error());
  if (const auto ref = request.query.find("model"); ref != request.query.end()) {
    const auto model = context.store.model(ref->second);
    if (!model && model.error().status != 404) return tl::unexpected(model.error());
    if (!model || model->project_id != project->id)
      return fail(422, "No such model",
                  "The project has no model `" + ref->second.substr(0, 100) + "`.", "model");
    query.model = model->id;
  }
  const auto found = context.store.activity(project->id, request.role(), query);
  if (!found) return tl::unexpected(found.error());
  nlohmann::json lines = nlohmann::json::array();
  for (const Activity& line : found->lines) lines.push_back(to_json(line));
  nlohmann::json answer{{"activity", std::move(lines)}};
  if (found->next) answer["next"] = to_text(*found->next);
  if (auto named = People::add_to(context.store, answer); !named)
    return tl::unexpected(named.error());
  return json_response(std::move(answer));
}

// From where a reader comes back, or from now.
Result<Response> listen(const RouteContext& context, const Request& request) {
  const auto model = context.store.model(request.param("model"));
  if (!model) return tl::unexpected(model.error());
  std::optional<store::ActivityPlace> after;
  if (const auto text = request.header("last-event-id"); !text.empty()) {
    after = place_of(text);
    if (!after)
      return fail(400, "No such event",
                  "`Last-Event-ID` is the id of an event: 1777896570120000-7, for example.",
                  "Last-Event-ID");
  }
  Response response;
  const auto events = std::make_shared<ModelEvents>(context, request, *model, after);
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
