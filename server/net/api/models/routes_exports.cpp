// 3D models for other programs.
#include <algorithm>
#include <bit>
#include <limits>

#include "app/exports/model_export.h"
#include "domain/scene/model.h"
#include "net/api/addressed.h"
#include "net/api/layers/region_reader.h"
#include "net/api/models/made_file.h"
#include "net/api/routes.h"
#include "net/http/entity_tags.h"
#include "net/serialization/as_of.h"
#include "net/serialization/at_field.h"
#include "net/serialization/view_settings_serialization.h"
#include "net/transport/server_options.h"
#include "room/edits.h"
#include "room/layers.h"
#include "room/room.h"
#include "room/view_settings.h"
#include "store/content/named_parts.h"
#include "store/store.h"

namespace strata::net {
namespace {

Result<app::ModelExport> read_export(const RouteContext& context, const Request& request) {
  const auto body = STRATA_TRY(body_of<protocol::ModelExportRequest>(request));
  app::ModelExport read;
  read.room = STRATA_TRY(open_room(context, request));
  STRATA_TRY(check_source_download(request, read.room->model()));
  read.role = request.role();
  read.shown = STRATA_TRY(view_settings(
      *read.room, body.layers.value_or(std::vector<protocol::LayerOverride>{}), body.looks, {}));
  read.layers = read.room->layers().all();
  std::erase_if(read.layers, [&](const Layer& layer) {
    return !read.shown.of(layer.id).visible.value_or(layer.visible);
  });
  room::sort_as_shown(read.layers, read.shown);
  if (body.format == protocol::ModelExportRequestFormat::obj)
    read.format = app::ModelFileFormat::obj;
  if (body.features) {
    if (read.format != app::ModelFileFormat::glb)
      return fail(
          ErrorCode::invalid, "No features in OBJ files",
          "OBJ files cannot contain features. Choose the format GLB, or send no `features`.",
          "features");
    auto layer = read.room->layers().find(protocol::to_ref(*body.features));
    if (!layer) return at_field(layer.error(), "features");
    read.features = std::move(*layer);
  }
  read.at = STRATA_TRY(find_sequence(context, *read.room, body.at));
  if (body.within) {
    protocol::Within within = *body.within;
    RegionReader reader(*read.room, context.store.selections(), request.user());
    read.within.emplace();
    read.within->within = STRATA_TRY(reader.read(within));
    read.within->at = read.at;
  }
  if (body.texture_size)
    read.texture_size = static_cast<int>(std::bit_ceil(static_cast<unsigned>(*body.texture_size)));
  read.texture_format = body.texture_format == protocol::ModelExportRequestTextureFormat::png
                            ? PictureFormat::png
                            : PictureFormat::jpeg;
  if (body.max_triangles) read.max_triangles = static_cast<std::size_t>(*body.max_triangles);
  read.unlit = body.unlit;
  read.language = STRATA_TRY(requested_language(request));
  return read;
}

Result<Response> answer_export(const RouteContext& context, const Request& request) {
  auto read = STRATA_TRY(read_export(context, request));
  const auto room = read.room;
  const std::int64_t sequence = read.at.value_or(room->edits().durable_state().sequence);
  return respond_with_file(
      context, request, *room, sequence, [&context, read = std::move(read)](Progress& progress) {
        return app::export_model(context, read, context.options.upload_dir, progress);
      });
}

// Reads the parameters of the query for a GLB file of the current state.
Result<app::ModelExport> read_surface(const RouteContext& context, const Request& request) {
  app::ModelExport read;
  read.room = STRATA_TRY(open_room(context, request));
  STRATA_TRY(check_source_download(request, read.room->model()));
  read.role = request.role();
  read.layers =
      STRATA_TRY(find_layers(*read.room, split_list(request.query_or("layers", {})), "layers"));
  std::ranges::sort(read.layers, {}, &Layer::order);
  if (const std::string side = request.query_or("texture_size", {}); !side.empty())
    read.texture_size = static_cast<int>(std::bit_ceil(
        static_cast<unsigned>(STRATA_TRY(parse_integer(side, 512, 8192, "texture_size")))));
  if (const std::string most = request.query_or("max_triangles", {}); !most.empty())
    read.max_triangles = static_cast<std::size_t>(STRATA_TRY(
        parse_integer(most, 100, std::numeric_limits<std::uint32_t>::max(), "max_triangles")));
  return read;
}

// Unlike an export, it needs no body, so viewers of IIIF manifests can load it.
Result<Response> get_surface(const RouteContext& context, const Request& request) {
  auto read = STRATA_TRY(read_surface(context, request));
  const auto room = read.room;
  return respond_with_file(context, request, *room, room->edits().durable_state().sequence,
                           [&context, read = std::move(read)](Progress& progress) {
                             return app::export_model(context, read, context.options.upload_dir,
                                                      progress);
                           });
}

}  // namespace

void add_export_routes(Router& router, const RouteContext& context) {
  router.add({.method = Method::post,
              .pattern = "/api/v1/models/{model}/exports",
              .handler = answering(
                  [&context](const Request& request) { return answer_export(context, request); }),
              .query = {"lang"},
              .body = BodyKind::memory,
              .max_body = context.options.max_json_bytes,
              .is_question = true});
  router.add({.method = Method::get,
              .pattern = "/api/v1/models/{model}/surface.glb",
              .handler = answering(
                  [&context](const Request& request) { return get_surface(context, request); }),
              .query = {"layers", "texture_size", "max_triangles"},
              .is_question = true,
              .state = state_of_model(context)});
}

}  // namespace strata::net
