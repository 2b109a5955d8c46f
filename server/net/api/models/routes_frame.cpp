#include "net/api/addressed.h"
#include "net/api/models/picture_response.h"
#include "net/api/route_help.h"
#include "net/api/routes.h"
#include "net/serialization/as_of.h"
#include "net/serialization/view_settings_serialization.h"
#include "net/transport/server_options.h"
#include "room/edits.h"
#include "room/layers.h"
#include "room/pictures.h"
#include "room/room.h"

namespace strata::net {
namespace {

Result<Response> frame(const RouteContext& context, const Request& request) {
  auto body = STRATA_TRY(body_of<protocol::FrameRequest>(request));
  auto room = open_room(context, request);
  if (!room) return tl::unexpected(room.error());
  room::PictureRequest picture_request;
  if (body.layers) {
    picture_request.layers.emplace();
    for (std::size_t i = 0; i < body.layers->size(); ++i) {
      auto layer = (*room)->layers().find(protocol::to_ref((*body.layers)[i]));
      if (!layer) {
        Error problem = layer.error();
        problem.field = "layers[" + std::to_string(i) + "]";
        return tl::unexpected(std::move(problem));
      }
      picture_request.layers->push_back(layer->slug);
    }
  }
  if (body.highlights) {
    for (std::size_t i = 0; i < body.highlights->size(); ++i) {
      const auto& highlighted = (*body.highlights)[i];
      const std::string field = "highlights[" + std::to_string(i) + "]";
      auto layer = (*room)->layers().find(protocol::to_ref(highlighted.layer));
      if (!layer) {
        Error problem = layer.error();
        problem.field = field + ".layer";
        return tl::unexpected(std::move(problem));
      }
      auto highlight =
          STRATA_TRY(highlight_of(highlighted.highlight, *layer, field + ".highlight"));
      picture_request.shown.layers.push_back(
          {layer->id, std::nullopt, std::nullopt, std::nullopt, std::move(highlight)});
    }
  }
  const auto sequence = (*room)->edits().sequence();
  const auto at = STRATA_TRY(find_sequence(context, **room, body.at));
  picture_request.at = at;
  if (body.looks) {
    auto images = STRATA_TRY(surface_image_views(**room, *body.looks));
    picture_request.shown.images = std::move(images);
  }
  if (body.light) picture_request.shown.light = *body.light;
  STRATA_TRY(validate(picture_request.shown.light));
  const auto background = STRATA_TRY(background_of(body.background));
  picture_request.shown.background = background;
  picture_request.samples = static_cast<int>(body.samples);
  picture_request.samples_time = kPictureSamplesTime;
  auto response = STRATA_TRY(picture_response(**room, picture_request, body.camera,
                                              body.format == protocol::FrameRequestFormat::png));
  add_sequences(response, picture_request.at.value_or(sequence),
                (*room)->edits().durable_sequence());
  return response;
}

}  // namespace

void add_frame_routes(Router& router, const RouteContext& context) {
  router.add(
      {.method = Method::post,
       .pattern = "/api/v1/models/{model}/frame",
       .handler = answering([&context](const Request& request) { return frame(context, request); }),
       .body = BodyKind::memory,
       .max_body = context.options.max_json_bytes,
       .is_question = true});
}

}  // namespace strata::net
