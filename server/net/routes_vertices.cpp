#include "net/as_of.h"
#include "net/routes.h"
#include "net/sheet.h"
#include "query/vertex_ply.h"

namespace strata::net {
namespace {

Result<Response> read_vertices(const RouteContext& context, const Request& request) {
  auto room = context.rooms.open(request.param("model"), request.role());
  if (!room) return tl::unexpected(room.error());
  if (auto may = check_source_download(request, (*room)->model()); !may) return tl::unexpected(may.error());
  std::vector<Layer> layers = (*room)->layers();
  if (const auto named = request.query.find("layers"); named != request.query.end()) {
    auto found = find_layers(**room, split_list(named->second), "layers");
    if (!found) return tl::unexpected(found.error());
    layers = std::move(*found);
  }
  const auto at = find_sequence(context, **room, as_of(request));
  if (!at) return tl::unexpected(at.error());
  const auto sequence = at->value_or((*room)->sequence());
  std::vector<query::LayerView> views;
  for (const Layer& layer : layers) {
    for (const query::LayerView& other : views)
      if (other.layer.id == layer.id) return fail(422, "Layer named twice", "Name each layer once.", "layers");
    auto tiles = (*room)->tiles(layer.slug, *at);
    if (!tiles) return tl::unexpected(tiles.error());
    views.push_back({layer, std::move(*tiles)});
  }
  const auto ply = std::make_shared<const query::VertexPly>((*room)->geometry(), std::move(views));
  Response response;
  response.with("Content-Type", "model/ply");
  name_download(response, (*room)->model().slug + ".ply");
  add_sequences(response, sequence, (*room)->durable_sequence());
  response.stream = Response::Stream{ply->bytes(), [ply](const Response::Sink& sink) { return ply->write(sink); }};
  return response;
}

}  // namespace

void add_vertex_routes(Router& router, const RouteContext& context) {
  router.add({.method = Method::get,
              .pattern = "/api/v1/models/{model}/vertices.ply",
              .handler = answering([&context](const Request& request) { return read_vertices(context, request); }),
              .query = {"layers", "at"},
              .is_question = true});
}

}  // namespace strata::net
