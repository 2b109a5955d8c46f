// The history of a model: its edits over time, and the differences between two states of a layer.
#include <algorithm>
#include <charconv>

#include "core/text/timestamp.h"
#include "domain/layers/layer.h"
#include "domain/people/role.h"
#include "domain/scene/camera.h"
#include "net/api/addressed.h"
#include "net/api/route_help.h"
#include "net/api/routes.h"
#include "net/serialization/as_of.h"
#include "net/serialization/people_serialization.h"
#include "net/transport/server_options.h"
#include "room/edits.h"
#include "room/layers.h"
#include "room/queries.h"
#include "room/room.h"
#include "store/content/layers.h"
#include "store/journal/journal_reads.h"
#include "store/store.h"

namespace strata::net {
namespace {

constexpr int kUsualIntervals = 120, kMaxIntervals = 500;
constexpr int kUsualSteps = 50, kMaxSteps = 200;

Result<std::optional<std::int64_t>> number_in(const Request& request, const std::string& name,
                                              std::int64_t least, std::int64_t most) {
  const auto found = request.query.find(name);
  if (found == request.query.end()) return std::nullopt;
  const std::string& text = found->second;
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || number < least || number > most)
    return fail(ErrorCode::invalid, "Invalid number",
                "`" + name + "` must be a whole number from " + std::to_string(least) + " to " +
                    std::to_string(most) + ".",
                name);
  return number;
}

Result<std::vector<LayerId>> seen_layers(const RouteContext& context, const Request& request,
                                         const Model& model) {
  std::vector<LayerId> ids;
  for (const Layer& layer : STRATA_TRY(context.store.layers().of_model(model.id, request.role())))
    ids.push_back(layer.id);
  return ids;
}

nlohmann::json to_json(const store::Timeline::Interval& interval) {
  nlohmann::json people = nlohmann::json::array(), layers = nlohmann::json::array();
  for (const auto& person : interval.people)
    people.push_back({{"user", person.user}, {"edits", person.edits}});
  for (const LayerId layer : interval.layers) layers.push_back(layer.number());
  return {{"number", interval.number},         {"edits", interval.edits},
          {"first", interval.first},           {"last", interval.last},
          {"begun", utc_text(interval.begun)}, {"ended", utc_text(interval.ended)},
          {"people", std::move(people)},       {"others", interval.others},
          {"layers", std::move(layers)}};
}

nlohmann::json to_json(const store::TimelineStep& step) {
  return {
      {"first", step.first},           {"last", step.last},      {"stroke", to_string(step.stroke)},
      {"layer", step.layer.number()},  {"op", step.op},          {"time", utc_text(step.time)},
      {"texels_changed", step.texels}, {"area_m2", step.area_m2}};
}

Result<Response> timeline(const RouteContext& context, const Request& request) {
  store::TimelineQuery query;
  query.from = STRATA_TRY(time_of(request, "from"));
  query.to = STRATA_TRY(time_of(request, "to"));
  const auto intervals = STRATA_TRY(number_in(request, "intervals", 1, kMaxIntervals));
  query.intervals = static_cast<int>(intervals.value_or(kUsualIntervals));
  if (query.from && query.to && *query.from > *query.to)
    return fail(ErrorCode::invalid, "Invalid time", "`to` must not be before `from`.", "to");
  const auto model = STRATA_TRY(stored_model(context, request));
  query.layers = STRATA_TRY(seen_layers(context, request, model));
  const auto found = STRATA_TRY(context.store.journal().timeline(model.id, query));
  nlohmann::json list = nlohmann::json::array();
  for (const auto& interval : found.intervals) list.push_back(to_json(interval));
  nlohmann::json answer{
      {"newest", model.sequence}, {"edits", found.edits}, {"intervals", std::move(list)}};
  if (found.from) answer["from"] = utc_text(*found.from);
  if (found.to) answer["to"] = utc_text(*found.to);
  STRATA_TRY(People::add_to(context.store, answer));
  return json_response(answer);
}

Result<Response> steps(const RouteContext& context, const Request& request) {
  const auto before = STRATA_TRY(number_in(request, "before", 0, INT64_MAX));
  const auto after = STRATA_TRY(number_in(request, "after", 0, INT64_MAX));
  const auto limit = STRATA_TRY(number_in(request, "limit", 1, kMaxSteps));
  if (before && after)
    return fail(ErrorCode::invalid, "Too many parameters",
                "Send either `before` or `after`, but not both.", "after");
  const auto model = STRATA_TRY(stored_model(context, request));
  const auto layers = STRATA_TRY(seen_layers(context, request, model));
  const auto found = STRATA_TRY(context.store.journal().timeline_steps(
      model.id, layers, after.value_or(before.value_or(INT64_MAX)), !after,
      static_cast<int>(limit.value_or(kUsualSteps))));
  nlohmann::json list = nlohmann::json::array();
  for (const auto& step : found.steps) {
    list.push_back(to_json(step));
    list.back()["user"] = step.user;
  }
  nlohmann::json answer{{"steps", std::move(list)}, {"more", found.more}};
  STRATA_TRY(People::add_to(context.store, answer));
  return json_response(answer);
}

// Returns the edits that undo and redo would change for the caller.
Result<Response> undo_steps(const RouteContext& context, const Request& request) {
  const auto limit = STRATA_TRY(number_in(request, "limit", 1, kMaxSteps));
  const auto model = STRATA_TRY(stored_model(context, request));
  store::UndoQuery query;
  query.limit = static_cast<int>(limit.value_or(kUsualSteps));
  for (const Layer& layer : STRATA_TRY(context.store.layers().of_model(model.id, request.role()))) {
    query.layers.push_back(layer.id);
    // Only curators can change an accepted edit.
    if (layer.review && request.role() < Role::curator) query.pending_only.push_back(layer.id);
  }
  const auto found =
      STRATA_TRY(context.store.journal().undo_steps(model.id, request.user(), query));
  const auto list_of = [](const std::vector<store::UndoStep>& found_steps) {
    nlohmann::json list = nlohmann::json::array();
    for (const store::UndoStep& step : found_steps) {
      list.push_back(to_json(step));
      if (step.value) list.back()["value"] = *step.value;
      if (step.erases) list.back()["erase"] = true;
    }
    return list;
  };
  return json_response(
      {{"done", list_of(found.done)}, {"undone", list_of(found.undone)}, {"more", found.more}});
}

Result<Response> difference(const RouteContext& context, const Request& request) {
  const auto body = STRATA_TRY(body_of<protocol::DifferenceRequest>(request));
  const auto room = STRATA_TRY(open_room(context, request));
  const auto layer = STRATA_TRY(room->layers().find(request.param("layer")));
  const auto sequence_of = [&](const protocol::At& at,
                               const std::string& field) -> Result<std::optional<std::int64_t>> {
    auto found = find_sequence(context, *room, at);
    if (found) return found;
    Error problem = found.error();
    if (problem.field == "at") problem.field = field;
    return tl::unexpected(std::move(problem));
  };
  const auto from = STRATA_TRY(sequence_of(body.from, "from"));
  // Uses a durable state, which cannot change while the response is created.
  std::optional<std::int64_t> to = room->edits().durable_sequence();
  if (body.to) to = STRATA_TRY(sequence_of(*body.to, "to"));
  std::optional<room::Outline> outline;
  if (body.within) {
    STRATA_TRY(validate(body.within->camera));
    outline = room::Outline{body.within->camera, body.within->path, body.within->through};
  }
  const auto found = STRATA_TRY(room->queries().difference(layer.slug, from, to, outline));
  Response response = json_response({{"from", *from},
                                     {"to", *to},
                                     {"texels", found.texels},
                                     {"area_m2", found.area_m2},
                                     {"share", found.share}});
  add_sequences(response, *to, room->edits().durable_sequence());
  return response;
}

}  // namespace

void add_timeline_routes(Router& router, const RouteContext& context) {
  router.add({.method = Method::get,
              .pattern = "/api/v1/models/{model}/timeline",
              .handler = answering(
                  [&context](const Request& request) { return timeline(context, request); }),
              .query = {"from", "to", "intervals"}});
  router.add(
      {.method = Method::get,
       .pattern = "/api/v1/models/{model}/timeline/steps",
       .handler = answering([&context](const Request& request) { return steps(context, request); }),
       .query = {"before", "after", "limit"}});
  router.add({.method = Method::get,
              .pattern = "/api/v1/models/{model}/undo",
              .handler = answering(
                  [&context](const Request& request) { return undo_steps(context, request); }),
              .query = {"limit"}});
  router.add({.method = Method::post,
              .pattern = "/api/v1/models/{model}/layers/{layer}/difference",
              .handler = answering(
                  [&context](const Request& request) { return difference(context, request); }),
              .body = BodyKind::memory,
              .max_body = context.options.max_json_bytes,
              .is_question = true});
}

}  // namespace strata::net
