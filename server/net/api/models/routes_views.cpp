// Saved views of a model. Viewers can read them, and annotators can create them. Authors can change
// their own views. Curators can change all of them.
#include <algorithm>
#include <cmath>

#include "domain/people/role.h"
#include "net/api/addressed.h"
#include "net/api/annotated_routes.h"
#include "net/api/models/picture_response.h"
#include "net/api/route_help.h"
#include "net/api/routes.h"
#include "net/http/idempotency_store.h"
#include "net/http/page.h"
#include "net/live/live_sockets.h"
#include "net/serialization/view_serialization.h"
#include "protocol/json_values.h"
#include "room/edits.h"
#include "room/pictures.h"
#include "room/room.h"
#include "room/view_settings.h"
#include "store/content/named_parts.h"
#include "store/store.h"

namespace strata::net {
namespace {

using protocol::ViewEventEvent;
using store::NamedPart;

constexpr int kSamples = 16;  // per pixel of a view's image

// Converts the shown settings in the body to their stored format, which contains ids because slugs
// can change.
template <class ViewBody>
Result<nlohmann::json> content_of(const room::Room& room, const ViewBody& body,
                                  const Camera& camera) {
  STRATA_TRY(validate(camera));
  const auto shown = body.layers.value_or(std::vector<protocol::LayerOverride>{});
  const auto settings = STRATA_TRY(shown_settings(room, body));
  nlohmann::json content{{"camera", protocol::write_core(camera)},
                         {"layers", stored_layers(shown, settings)},
                         {"light", protocol::write_core(settings.light)}};
  if (settings.images) {
    content["looks"] = nlohmann::json::array();
    for (const room::SurfaceImageView& image : *settings.images)
      content["looks"].push_back({{"look", image.surface_image_id}, {"opacity", image.opacity}});
  }
  return content;
}

// The room of a model and one of its saved views.
struct Found {
  std::shared_ptr<room::Room> room;
  NamedPart view;
};
Result<Found> find_view(const RouteContext& context, const Request& request) {
  auto room = STRATA_TRY(open_room(context, request));
  auto view = context.store.views().find(room->model().id, request.param("view"));
  if (!view) return tl::unexpected(view.error());
  return Found{std::move(room), std::move(*view)};
}

Result<Found> find_own_view(const RouteContext& context, const Request& request) {
  auto found = STRATA_TRY(find_view(context, request));
  STRATA_TRY(check_if_match(request, found.view.version));
  if (found.view.user != request.user() && request.role() < Role::curator)
    return fail(ErrorCode::forbidden, "Not allowed",
                "Only " + found.view.user +
                    " and curators can change this view. Save your own view under another name.");
  return found;
}

void tell(const RouteContext& context, ViewEventEvent event, const NamedPart& view,
          const std::string& user) {
  protocol::ViewEvent message;
  message.event = event;
  message.view = view.id.number();
  message.user = user;
  context.live_sockets.tell_model(view.model_id, message);
}

Result<Response> list_views(const RouteContext& context, const Request& request) {
  const auto page = STRATA_TRY(page_of(request));
  const auto room = STRATA_TRY(open_room(context, request));
  const auto after = STRATA_TRY(number_after(page));
  auto found = context.store.views().of_model(room->model().id, page.limit + 1, page.offset, after);
  if (!found) return tl::unexpected(found.error());
  const auto last = end_page(found->parts, page,
                             [](const NamedPart& view) { return ListPlace::array({view.id}); });
  nlohmann::json views = nlohmann::json::array();
  for (const NamedPart& view : found->parts)
    views.push_back(to_json(context, request, view, *room));
  Response response = json_response({{"views", std::move(views)}, {"total", found->total}});
  add_page_links(response, request, page, last);
  return response;
}

Result<Response> get_view(const RouteContext& context, const Request& request) {
  const auto found = STRATA_TRY(find_view(context, request));
  return with_etag(json_response(to_json(context, request, found.view, *found.room)), request,
                   found.view.version);
}

// Returns an image of the view with its current content, as visible to the caller.
Result<Response> view_picture(const RouteContext& context, const Request& request) {
  std::optional<int> side;
  if (const std::string text = request.query_or("thumbnail", {}); !text.empty()) {
    const auto number = STRATA_TRY(parse_integer(text, 16, 1024, "thumbnail"));
    side = static_cast<int>(number);
  }
  const std::string format = request.query_or("format", "jpeg");
  if (format != "jpeg" && format != "png")
    return fail(ErrorCode::invalid, "Unknown format",
                "The format of a picture must be 'jpeg' or 'png'.", "format");
  const auto found = STRATA_TRY(find_view(context, request));
  const auto saved = STRATA_TRY(as_view_create(context, request, found.view, *found.room));
  auto shown = shown_settings(*found.room, saved);
  if (!shown) return tl::unexpected(shown.error());
  room::PictureRequest picture_request;
  Camera camera = saved.camera;
  if (side) {
    const double scale = std::min(1.0, double(*side) / std::max(camera.width, camera.height));
    camera.width = std::max(1, static_cast<int>(std::lround(camera.width * scale)));
    camera.height = std::max(1, static_cast<int>(std::lround(camera.height * scale)));
  }
  picture_request.shown = std::move(*shown);
  picture_request.samples = kSamples;
  picture_request.samples_time = kPictureSamplesTime;
  const auto sequence = found.room->edits().sequence();
  auto response = picture_response(*found.room, picture_request, camera, format == "png");
  if (!response) return response;
  add_sequences(*response, sequence, found.room->edits().durable_sequence());
  return response;
}

Result<Response> create_view(const RouteContext& context, const Request& request) {
  const auto body = STRATA_TRY(body_of<protocol::ViewCreate>(request));
  const auto room = STRATA_TRY(open_room(context, request));
  auto content = STRATA_TRY(content_of(*room, body, body.camera));
  NamedPart view;
  view.model_id = room->model().id;
  view.name = body.name;
  view.text = body.text.value_or("");
  view.content = std::move(content);
  view.user = request.user();
  const auto answer = [&](const NamedPart& made) {
    return json_response(to_json(context, request, made, *room), 201)
        .with("Location", "/api/v1/models/" + room->model().slug + "/views/" + made.slug)
        .with("ETag", etag_of(made.version));
  };
  const auto made = STRATA_TRY(
      context.store.views().create(view, idempotent_response<NamedPart>(request, answer)));
  tell(context, ViewEventEvent::created, made, request.user());
  return answer(made);
}

Result<Response> change_view(const RouteContext& context, const Request& request) {
  const auto body = STRATA_TRY(body_of<protocol::ViewPatch>(request));
  auto found = STRATA_TRY(find_own_view(context, request));
  NamedPart& view = found.view;
  if (body.name) view.name = *body.name;
  if (body.text) view.text = *body.text;
  if (body.camera) {
    auto content = content_of(*found.room, body, *body.camera);
    if (!content) return tl::unexpected(content.error());
    view.content = std::move(*content);
  }
  const auto answer = [&](const NamedPart& now) {
    return json_response(to_json(context, request, now, *found.room))
        .with("ETag", etag_of(now.version));
  };
  const auto changed = STRATA_TRY(
      context.store.views().update(view, idempotent_response<NamedPart>(request, answer)));
  tell(context, ViewEventEvent::changed, changed, request.user());
  return answer(changed);
}

Result<Response> delete_view(const RouteContext& context, const Request& request) {
  const auto found = STRATA_TRY(find_own_view(context, request));
  const auto answer = [] { return empty_response(204); };
  STRATA_TRY(context.store.views().remove(found.view, idempotent_response<>(request, answer)));
  tell(context, ViewEventEvent::deleted, found.view, request.user());
  return answer();
}

}  // namespace

void add_view_routes(Router& router, const RouteContext& context) {
  AnnotatedRoutes routes(router, context);
  const std::string views = "/api/v1/models/{model}/views", view = views + "/{view}";
  routes.read(views, list_views, {"limit", "offset", "after"});
  routes.change(Method::post, views, create_view);
  routes.read(view, get_view);
  routes.read(view + "/picture", view_picture, {"thumbnail", "format"}, state_of_model(context));
  routes.change(Method::patch, view, change_view);
  routes.change(Method::remove, view, delete_view);
}

}  // namespace strata::net
