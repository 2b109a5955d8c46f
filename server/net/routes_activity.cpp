// What was done in a project.
#include <charconv>

#include "core/timestamp.h"
#include "net/routes.h"
#include "net/wire.h"

namespace strata::net {
namespace {

using store::Activity;
using store::ActivityPlace;

nlohmann::json to_json(const Activity& line) {
  nlohmann::json json{
      {"id", line.id}, {"time", utc_text(line.time)}, {"begun", utc_text(line.begun)}, {"kind", line.kind},
      {"op", line.op}, {"count", line.count}};
  const auto put_text = [&](const char* name, const std::string& text) {
    if (!text.empty()) json[name] = text;
  };
  const auto put = [&](const char* name, const auto& value) {
    if (value) json[name] = *value;
  };
  put_text("user", line.user);
  put_text("name", line.name);
  put("model", line.model);
  put_text("model_name", line.model_name);
  put("layer", line.layer);
  put("table", line.table);
  put("record", line.record);
  put("comment", line.comment);
  put_text("text", line.text);
  put_text("person", line.person);
  put_text("role", line.role);
  put("texels", line.texels);
  put("area_m2", line.area_m2);
  if (!line.changed.empty()) json["changed"] = line.changed;
  return json;
}

std::string to_text(const ActivityPlace& place) {
  return std::to_string(place.time_us) + "-" + std::to_string(place.id);
}

// 16 and 15 digits at most, so that both are far from what their columns hold.
std::optional<ActivityPlace> place_of(std::string_view text) {
  const std::size_t dash = text.find('-');
  if (dash == std::string_view::npos) return std::nullopt;
  const auto number = [](std::string_view digits, std::size_t most, std::int64_t& into) {
    if (digits.empty() || digits.size() > most || digits.front() == '-') return false;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), into);
    return error == std::errc() && end == digits.data() + digits.size();
  };
  ActivityPlace place;
  if (!number(text.substr(0, dash), 16, place.time_us) || !number(text.substr(dash + 1), 15, place.id))
    return std::nullopt;
  return place;
}

Result<Response> list_activity(const RouteContext& context, const Request& request) {
  const auto page = page_of(request);
  if (!page) return tl::unexpected(page.error());
  store::ActivityQuery query;
  query.limit = page->limit;
  query.with_members = request.principal->role >= Role::curator;
  if (const auto before = request.query.find("before"); before != request.query.end()) {
    query.before = place_of(before->second);
    if (!query.before)
      return fail(422, "No such page", "`before` is `next` of an answer: 1777896570120000-7, for example.", "before");
  }
  const auto project = context.store.project(request.param("project"));
  if (!project) return tl::unexpected(project.error());
  if (const auto ref = request.query.find("model"); ref != request.query.end()) {
    const auto model = context.store.model(ref->second);
    if (!model && model.error().status != 404) return tl::unexpected(model.error());
    if (!model || model->project_id != project->id)
      return fail(422, "No such model", "The project has no model `" + ref->second.substr(0, 100) + "`.", "model");
    query.model = model->id;
  }
  const auto found = context.store.activity(project->id, request.role(), query);
  if (!found) return tl::unexpected(found.error());
  nlohmann::json lines = nlohmann::json::array();
  for (const Activity& line : found->lines) lines.push_back(to_json(line));
  nlohmann::json answer{{"activity", std::move(lines)}};
  if (found->next) answer["next"] = to_text(*found->next);
  return json_response(std::move(answer));
}

}  // namespace

void add_activity_routes(Router& router, const RouteContext& context) {
  router.add({.method = Method::get,
              .pattern = "/api/v1/projects/{project}/activity",
              .handler = answering([&context](const Request& request) { return list_activity(context, request); }),
              .query = {"model", "before", "limit"}});
}

}  // namespace strata::net
