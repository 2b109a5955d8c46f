#include "net/as_of.h"
#include "net/picture_response.h"
#include "net/routes.h"
#include "net/wire.h"

namespace strata::net {
namespace {

Result<Response> frame(const RouteContext& context, const Request& request) {
  auto asked = body_of<protocol::FrameRequest>(request);
  if (!asked) return tl::unexpected(asked.error());
  auto room = context.rooms.open(request.param("model"), request.role());
  if (!room) return tl::unexpected(room.error());
  room::PictureRequest wanted;
  if (asked->layers) {
    wanted.layers.emplace();
    for (std::size_t i = 0; i < asked->layers->size(); ++i) {
      auto layer = (*room)->layer(protocol::to_ref((*asked->layers)[i]));
      if (!layer) {
        Problem problem = layer.error();
        problem.field = "layers[" + std::to_string(i) + "]";
        return tl::unexpected(std::move(problem));
      }
      wanted.layers->push_back(layer->slug);
    }
  }
  if (asked->highlights) {
    for (std::size_t i = 0; i < asked->highlights->size(); ++i) {
      const auto& wished = (*asked->highlights)[i];
      const std::string field = "highlights[" + std::to_string(i) + "]";
      auto layer = (*room)->layer(protocol::to_ref(wished.layer));
      if (!layer) {
        Problem problem = layer.error();
        problem.field = field + ".layer";
        return tl::unexpected(std::move(problem));
      }
      auto highlight = highlight_of(wished.highlight, *layer, field + ".highlight");
      if (!highlight) return tl::unexpected(highlight.error());
      wanted.shown.layers.push_back(
          {layer->id, std::nullopt, std::nullopt, std::nullopt, std::move(*highlight)});
    }
  }
  const auto sequence = (*room)->sequence();
  const auto at = find_sequence(context, **room, asked->at);
  if (!at) return tl::unexpected(at.error());
  wanted.at = *at;
  if (asked->looks) {
    auto looks = look_views(**room, *asked->looks);
    if (!looks) return tl::unexpected(looks.error());
    wanted.shown.looks = std::move(*looks);
  }
  if (asked->light) wanted.shown.light = *asked->light;
  if (auto lit = validate(wanted.shown.light); !lit) return tl::unexpected(lit.error());
  const auto background = background_of(asked->background);
  if (!background) return tl::unexpected(background.error());
  wanted.shown.background = *background;
  auto response = picture_response(**room, wanted, asked->camera,
                                   asked->format == protocol::FrameRequestFormat::png);
  if (!response) return response;
  add_sequences(*response, wanted.at.value_or(sequence), (*room)->durable_sequence());
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
