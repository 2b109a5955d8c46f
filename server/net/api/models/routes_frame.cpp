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
  room::PictureRequest wanted;
  if (body.layers) {
    wanted.layers.emplace();
    for (std::size_t i = 0; i < body.layers->size(); ++i) {
      auto layer = (*room)->layers().find(protocol::to_ref((*body.layers)[i]));
      if (!layer) {
        Error problem = layer.error();
        problem.field = "layers[" + std::to_string(i) + "]";
        return tl::unexpected(std::move(problem));
      }
      wanted.layers->push_back(layer->slug);
    }
  }
  if (body.highlights) {
    for (std::size_t i = 0; i < body.highlights->size(); ++i) {
      const auto& wished = (*body.highlights)[i];
      const std::string field = "highlights[" + std::to_string(i) + "]";
      auto layer = (*room)->layers().find(protocol::to_ref(wished.layer));
      if (!layer) {
        Error problem = layer.error();
        problem.field = field + ".layer";
        return tl::unexpected(std::move(problem));
      }
      auto highlight = STRATA_TRY(highlight_of(wished.highlight, *layer, field + ".highlight"));
      wanted.shown.layers.push_back(
          {layer->id, std::nullopt, std::nullopt, std::nullopt, std::move(highlight)});
    }
  }
  const auto sequence = (*room)->edits().sequence();
  const auto at = STRATA_TRY(find_sequence(context, **room, body.at));
  wanted.at = at;
  if (body.looks) {
    auto images = STRATA_TRY(surface_image_views(**room, *body.looks));
    wanted.shown.images = std::move(images);
  }
  if (body.light) wanted.shown.light = *body.light;
  STRATA_TRY(validate(wanted.shown.light));
  const auto background = STRATA_TRY(background_of(body.background));
  wanted.shown.background = background;
  auto response = STRATA_TRY(picture_response(**room, wanted, body.camera,
                                              body.format == protocol::FrameRequestFormat::png));
  add_sequences(response, wanted.at.value_or(sequence), (*room)->edits().durable_sequence());
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
