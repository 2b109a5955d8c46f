#include "app/layers/vertex_colors.h"
#include "net/api/addressed.h"
#include "net/api/route_help.h"
#include "net/api/routes.h"
#include "net/serialization/as_of.h"
#include "net/serialization/sheet_response.h"
#include "query/sampling/vertex_ply.h"
#include "room/at.h"
#include "room/edits.h"
#include "room/layers.h"
#include "room/queries.h"
#include "room/room.h"
#include "room/surface.h"
#include "room/view_settings.h"

namespace strata::net {
namespace {

// The file to send and the memory reserved for it.
struct VertexFile {
  MemoryLedger::Share memory;
  query::VertexPly ply;
};

// Returns the layers in the query, in the same order. Without this parameter, returns all layers in
// the order of the model.
Result<std::vector<query::LayerView>> layer_views(const Request& request, room::Room& room,
                                                  room::At at) {
  std::vector<Layer> layers = room.layers().all();
  if (const auto named = request.query.find("layers"); named != request.query.end()) {
    auto found = find_layers(room, split_list(named->second), "layers");
    if (!found) return tl::unexpected(found.error());
    layers = std::move(*found);
  }
  std::vector<query::LayerView> views;
  for (const Layer& layer : layers) {
    for (const query::LayerView& other : views)
      if (other.layer.id == layer.id)
        return fail(ErrorCode::invalid, "Duplicate layer",
                    "The request contains a layer twice. Send each layer only once.", "layers");
    auto tiles = STRATA_TRY(room.queries().tiles(layer.slug, at));
    views.push_back({layer, std::move(tiles)});
  }
  return views;
}

// Returns whether the vertices get the colors of the layers. By default, they keep the colors of
// the scan. A client can then import the mesh as a scan again without the colors of the layers.
Result<bool> wants_layer_colors(const Request& request) {
  const std::string colors = request.query_or("colors", "scan");
  if (colors != "scan" && colors != "layers")
    return fail(ErrorCode::invalid, "Invalid colors",
                "`colors` must be `scan` (the colors of the file, the default) or `layers` "
                "(the colors of the layers).",
                "colors");
  return colors == "layers";
}

// Returns the layers in drawing order. These are the layers in the query, in the same order, or the
// visible layers in the order of the model.
std::vector<query::LayerView> shown_layers(const Request& request,
                                           std::vector<query::LayerView> views) {
  if (request.query.contains("layers")) return views;
  std::erase_if(views, [](const query::LayerView& view) { return !view.layer.visible; });
  room::sort_as_shown(views, room::ViewSettings{});
  return views;
}

Result<Response> read_vertices(const RouteContext& context, const Request& request) {
  auto room = STRATA_TRY(open_room(context, request));
  STRATA_TRY(check_source_download(request, room->model()));
  const auto by_layers = STRATA_TRY(wants_layer_colors(request));
  const auto at = STRATA_TRY(find_sequence(context, *room, as_of(request)));
  const auto sequence = at.value_or(room->edits().sequence());
  auto views = STRATA_TRY(layer_views(request, *room, at));
  MemoryLedger::Share memory;
  std::optional<query::VertexColors> colors;
  if (by_layers) {
    auto composed =
        app::compose_vertices(context, *room, request.role(), shown_layers(request, views));
    if (!composed) return tl::unexpected(composed.error());
    memory = std::move(composed->memory);
    colors = std::move(composed->colors);
  }
  query::VertexPly ply(room->surface().geometry(), std::move(views), std::move(colors));
  const auto file =
      std::make_shared<const VertexFile>(VertexFile{std::move(memory), std::move(ply)});
  Response response;
  response.with("Content-Type", "model/ply");
  name_download(response, room->model().slug + ".ply");
  add_sequences(response, sequence, room->edits().durable_sequence());
  response.stream = Response::Stream{
      file->ply.bytes(), [file](const Response::Sink& sink) { return file->ply.write(sink); }};
  return response;
}

}  // namespace

void add_vertex_routes(Router& router, const RouteContext& context) {
  router.add({.method = Method::get,
              .pattern = "/api/v1/models/{model}/vertices.ply",
              .handler = answering(
                  [&context](const Request& request) { return read_vertices(context, request); }),
              .query = {"layers", "colors", "at"},
              .is_question = true,
              .state = state_of_model(context)});
}

}  // namespace strata::net
