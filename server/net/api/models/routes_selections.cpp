// Saved selections of a model. Viewers can read and use those for everyone, and annotators can
// create them. Only their creators see personal selections. Curators can change all selections for
// everyone.
#include "app/authorization/visibility_leak_check.h"
#include "core/text/timestamp.h"
#include "domain/people/role.h"
#include "domain/people/visibility.h"
#include "net/api/addressed.h"
#include "net/api/annotated_routes.h"
#include "net/api/layers/region_reader.h"
#include "net/api/route_help.h"
#include "net/api/routes.h"
#include "net/http/idempotency_store.h"
#include "net/http/page.h"
#include "net/live/live_sockets.h"
#include "room/layers.h"
#include "room/pipeline/expression_binding.h"
#include "room/room.h"
#include "room/selection.h"
#include "store/content/named_parts.h"
#include "store/store.h"

namespace strata::net {
namespace {

using protocol::SelectionEventEvent;
using store::NamedPart;

constexpr const char* kAudience = "audience";
constexpr const char* kWithin = "within";

bool is_personal(const NamedPart& selection) {
  return selection.content.at(kAudience) == "personal";
}

Result<void> check_visible(const Layer& layer, Visibility audience, const std::string& field) {
  if (layer.visibility <= audience) return {};
  return fail(ErrorCode::invalid, "Layer is hidden from some users",
              "Not all users who would see the selection can see " + layer.name +
                  ". Choose another layer, or save a personal selection.",
              field);
}

// Checks a definition, and returns it with ids. `id` is that of the changed selection, or 0.
Result<nlohmann::json> content_of(const RouteContext& context, const Request& request,
                                  const room::Room& room, protocol::Within within, bool personal,
                                  std::int64_t id) {
  RegionReader reader(room, context.store.selections(), request.user());
  if (id != 0) reader.forbid(id);
  room::Selection selection;
  selection.within = STRATA_TRY(reader.read(within));
  if (!personal && !reader.personal_field().empty())
    return fail(ErrorCode::invalid, "Personal selection",
                "A selection for everyone cannot use a personal selection. Save that one for "
                "everyone, too.",
                reader.personal_field());
  const Visibility audience = personal ? sight_of(request.role()) : Visibility::everyone;
  for (const room::LayerRead& read : room::layers_compared(selection)) {
    const auto layer = STRATA_TRY(room.layers().find(read.slug));
    STRATA_TRY(check_visible(layer, audience, read.field));
  }
  std::vector<query::LayerView> layers;
  for (const Layer& layer : room.layers().all()) layers.push_back({layer, {}});
  STRATA_TRY(room::for_each_leaf(*selection.within, [&](const room::Region& leaf) -> Result<void> {
    const auto* where = std::get_if<room::Selection::Where>(&leaf.area);
    if (!where) return {};
    STRATA_TRY(room::bind_for_layer(where->condition, layers, context.store, request.role(),
                                    audience, leaf.field + ".where"));
    return {};
  }));
  return nlohmann::json{{kAudience, personal ? "personal" : "everyone"},
                        {kWithin, protocol::to_json(within)}};
}

// Returns whether the caller can see everything that the definition reads.
Result<bool> sees_all_in(const RouteContext& context, const Request& request,
                         const room::Room& room, const NamedPart& selection) {
  protocol::Within within;
  protocol::read(selection.content.at(kWithin), within);
  RegionReader reader(room, context.store.selections(), request.user());
  const auto region = reader.read(within);
  if (!region) {
    if (region.error().code == ErrorCode::not_found || region.error().code == ErrorCode::invalid)
      return false;
    return tl::unexpected(region.error());
  }
  bool sees_all = true;
  STRATA_TRY(room::for_each_leaf(*region, [&](const room::Region& leaf) -> Result<void> {
    const auto* where = std::get_if<room::Selection::Where>(&leaf.area);
    if (!where || !sees_all) return {};
    sees_all =
        STRATA_TRY(app::sees_all_of(context.store, request.role(), room.model().id, where->text));
    return {};
  }));
  return sees_all;
}

// Contains the definition only if the caller sees everything that it reads (sees_all_in).
nlohmann::json to_json(const Request& request, const NamedPart& selection, bool sees_all) {
  nlohmann::json json{{"id", selection.id},
                      {"slug", selection.slug},
                      {"name", selection.name},
                      {"text", selection.text},
                      {kAudience, selection.content.at(kAudience)},
                      {"user", visible_name(request, selection.user)},
                      {"time", utc_text(selection.time)},
                      {"version", selection.version}};
  if (sees_all) json[kWithin] = selection.content.at(kWithin);
  return json;
}

// The room of a model and one of its saved selections.
struct Found {
  std::shared_ptr<room::Room> room;
  NamedPart selection;
};
Result<Found> find_selection(const RouteContext& context, const Request& request) {
  auto room = STRATA_TRY(open_room(context, request));
  auto selection = STRATA_TRY(context.store.selections().find(
      room->model().id, request.param("selection"), request.user()));
  return Found{std::move(room), std::move(selection)};
}

Result<Found> find_own_selection(const RouteContext& context, const Request& request) {
  auto found = STRATA_TRY(find_selection(context, request));
  STRATA_TRY(check_if_match(request, found.selection.version));
  if (found.selection.user != request.user() && request.role() < Role::curator)
    return fail(ErrorCode::forbidden, "Not allowed",
                "Only " + found.selection.user +
                    " and curators can change this selection. Save your own selection.");
  return found;
}

// Notifies the users who see the selection.
void tell(const RouteContext& context, SelectionEventEvent event, const NamedPart& selection,
          const std::string& user) {
  protocol::SelectionEvent message;
  message.event = event;
  message.selection = selection.id.number();
  message.user = user;
  if (is_personal(selection))
    context.live_sockets.tell_user(selection.model_id, selection.user, message);
  else
    context.live_sockets.tell_model(selection.model_id, message);
}

Result<Response> list_selections(const RouteContext& context, const Request& request) {
  const auto page = STRATA_TRY(page_of(request));
  const auto room = STRATA_TRY(open_room(context, request));
  const auto after = STRATA_TRY(number_after(page));
  auto found = STRATA_TRY(context.store.selections().of_model(room->model().id, page.limit + 1,
                                                              page.offset, after, request.user()));
  const auto last = end_page(found.parts, page,
                             [](const NamedPart& part) { return ListPlace::array({part.id}); });
  nlohmann::json selections = nlohmann::json::array();
  for (const NamedPart& selection : found.parts) {
    const bool sees_all = STRATA_TRY(sees_all_in(context, request, *room, selection));
    selections.push_back(to_json(request, selection, sees_all));
  }
  Response response =
      json_response({{"selections", std::move(selections)}, {"total", found.total}});
  add_page_links(response, request, page, last);
  return response;
}

Result<Response> get_selection(const RouteContext& context, const Request& request) {
  const auto found = STRATA_TRY(find_selection(context, request));
  const bool sees_all = STRATA_TRY(sees_all_in(context, request, *found.room, found.selection));
  return with_etag(json_response(to_json(request, found.selection, sees_all)), request,
                   found.selection.version);
}

Result<Response> create_selection(const RouteContext& context, const Request& request) {
  const auto body = STRATA_TRY(body_of<protocol::SavedSelectionCreate>(request));
  const auto room = STRATA_TRY(open_room(context, request));
  const bool personal = body.audience == protocol::SelectionAudience::personal;
  NamedPart selection;
  selection.model_id = room->model().id;
  selection.name = body.name;
  selection.text = body.text.value_or("");
  selection.content = STRATA_TRY(content_of(context, request, *room, body.within, personal, 0));
  selection.user = request.user();
  // `answer` also runs in the transaction, which must not wait for another connection.
  const bool sees_all = STRATA_TRY(sees_all_in(context, request, *room, selection));
  const auto answer = [&](const NamedPart& made) {
    return json_response(to_json(request, made, sees_all), 201)
        .with("Location", "/api/v1/models/" + room->model().slug + "/selections/" + made.slug)
        .with("ETag", etag_of(made.version));
  };
  const auto made = STRATA_TRY(context.store.selections().create(
      selection, idempotent_response<NamedPart>(request, answer)));
  tell(context, SelectionEventEvent::created, made, request.user());
  return answer(made);
}

Result<Response> change_selection(const RouteContext& context, const Request& request) {
  const auto body = STRATA_TRY(body_of<protocol::SavedSelectionPatch>(request));
  auto found = STRATA_TRY(find_own_selection(context, request));
  NamedPart& selection = found.selection;
  const NamedPart before = selection;
  if (body.name) selection.name = *body.name;
  if (body.text) selection.text = *body.text;
  if (body.within || body.audience) {
    bool personal = is_personal(selection);
    if (body.audience) personal = *body.audience == protocol::SelectionAudience::personal;
    protocol::Within within;
    if (body.within)
      within = *body.within;
    else
      protocol::read(selection.content.at(kWithin), within);
    selection.content = STRATA_TRY(content_of(context, request, *found.room, std::move(within),
                                              personal, selection.id.number()));
  }
  const bool sees_all = STRATA_TRY(sees_all_in(context, request, *found.room, selection));
  const auto answer = [&](const NamedPart& now) {
    return json_response(to_json(request, now, sees_all)).with("ETag", etag_of(now.version));
  };
  const auto changed = STRATA_TRY(context.store.selections().update(
      selection, idempotent_response<NamedPart>(request, answer)));
  // For other users, a selection that becomes personal is deleted, and one that was personal is
  // new. Its user gets the last event.
  if (is_personal(changed) && !is_personal(before))
    tell(context, SelectionEventEvent::deleted, before, request.user());
  const bool is_new = is_personal(before) && !is_personal(changed);
  tell(context, is_new ? SelectionEventEvent::created : SelectionEventEvent::changed, changed,
       request.user());
  return answer(changed);
}

Result<Response> delete_selection(const RouteContext& context, const Request& request) {
  const auto found = STRATA_TRY(find_own_selection(context, request));
  const auto answer = [] { return empty_response(204); };
  STRATA_TRY(
      context.store.selections().remove(found.selection, idempotent_response<>(request, answer)));
  tell(context, SelectionEventEvent::deleted, found.selection, request.user());
  return answer();
}

}  // namespace

void add_selection_routes(Router& router, const RouteContext& context) {
  AnnotatedRoutes routes(router, context);
  const std::string selections = "/api/v1/models/{model}/selections",
                    selection = selections + "/{selection}";
  routes.read(selections, list_selections, {"limit", "offset", "after"});
  routes.change(Method::post, selections, create_selection);
  routes.read(selection, get_selection);
  routes.change(Method::patch, selection, change_selection);
  routes.change(Method::remove, selection, delete_selection);
}

}  // namespace strata::net
