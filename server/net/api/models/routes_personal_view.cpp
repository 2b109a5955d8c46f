// The private settings of a user for the layers of a model.
#include "domain/people/role.h"
#include "net/api/addressed.h"
#include "net/api/models/personal_view.h"
#include "net/serialization/view_serialization.h"
#include "net/transport/server_options.h"
#include "room/room.h"
#include "store/people/personal_views.h"
#include "store/store.h"

namespace strata::net {

Result<nlohmann::json> personal_view(store::Store& store, const std::string& user, Role role,
                                     const room::Room& room) {
  auto layers = STRATA_TRY(store.personal_views().find(user, room.model().id));
  leave_out_unseen(store, role, room, layers);
  return nlohmann::json{{"layers", std::move(layers)}};
}

namespace {

Result<Response> get_view(const RouteContext& context, const Request& request) {
  const auto room = STRATA_TRY(open_room(context, request));
  const auto view = STRATA_TRY(personal_view(context.store, request.user(), request.role(), *room));
  return json_response(view).with("Cache-Control", "no-store");
}

Result<Response> put_view(const RouteContext& context, const Request& request) {
  const auto body = STRATA_TRY(body_of<protocol::PersonalView>(request));
  for (std::size_t i = 0; i < body.layers.size(); ++i)
    if (body.layers[i].highlight)
      return fail(ErrorCode::invalid, "Highlights not allowed",
                  "Only saved views can store highlighted records. Leave them out here.",
                  "layers[" + std::to_string(i) + "].highlight");
  const auto room = STRATA_TRY(open_room(context, request));
  const auto settings = STRATA_TRY(view_settings(*room, body.layers, {}, {}));
  if (auto saved = context.store.personal_views().keep(request.user(), room->model().id,
                                                       stored_layers(body.layers, settings));
      !saved)
    return tl::unexpected(saved.error());
  return get_view(context, request);
}

Result<Response> delete_view(const RouteContext& context, const Request& request) {
  const auto model = STRATA_TRY(stored_model(context, request));
  if (auto gone =
          context.store.personal_views().keep(request.user(), model.id, nlohmann::json::array());
      !gone)
    return tl::unexpected(gone.error());
  return empty_response(204);
}

}  // namespace

void add_personal_view_routes(Router& router, const RouteContext& context) {
  const std::string view = "/api/v1/me/models/{model}/view";
  router.add({.method = Method::get,
              .pattern = view,
              .handler = answering(
                  [&context](const Request& request) { return get_view(context, request); })});
  router.add({.method = Method::put,
              .pattern = view,
              .handler = answering(
                  [&context](const Request& request) { return put_view(context, request); }),
              .body = BodyKind::memory,
              .max_body = context.options.max_json_bytes});
  router.add({.method = Method::remove,
              .pattern = view,
              .handler = answering(
                  [&context](const Request& request) { return delete_view(context, request); })});
}

}  // namespace strata::net
