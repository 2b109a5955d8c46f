#include <fstream>

#include "net/digest.h"
#include "net/routes.h"
#include "query/raster.h"

namespace strata::net {
namespace {

struct Format {
  const char* extension;
  const char* media_type;
  Result<std::vector<std::uint8_t>> (*encode)(const Layer&, const TileMap&);
  Result<TileMap> (*decode)(const Layer&, std::span<const std::uint8_t>);
};
constexpr Format kFormats[] = {{"tif", "image/tiff", query::encode_tiff, query::decode_tiff},
                               {"png", "image/png", query::encode_png, query::decode_png},
                               {"npy", "application/x-npy", query::encode_npy, query::decode_npy}};

Result<const Format*> format_of(const Request& request) {
  for (const Format& format : kFormats)
    if (request.param("format") == format.extension) return &format;
  return fail(404, "Unknown raster format", "Texels are there as texels.tif, texels.png and texels.npy.", "format");
}

Result<Response> read_texels(const RouteContext& context, const Request& request) {
  auto format = format_of(request);
  if (!format) return tl::unexpected(format.error());
  auto room = context.rooms.open(request.param("model"));
  if (!room) return tl::unexpected(room.error());
  auto layer = (*room)->layer(request.param("layer"));
  if (!layer) return tl::unexpected(layer.error());
  std::optional<std::int64_t> at;
  if (auto text = request.query.find("at"); text != request.query.end()) {
    auto sequence = parse_integer(text->second, 0, (*room)->sequence(), "at");
    if (!sequence) return tl::unexpected(sequence.error());
    at = *sequence;
  }
  auto snapshot = (*room)->tiles(layer->slug, at);
  if (!snapshot) return tl::unexpected(snapshot.error());
  auto bytes = (*format)->encode(*layer, snapshot->tiles);
  if (!bytes) return tl::unexpected(bytes.error());
  Response response = bytes_response(std::move(*bytes), (*format)->media_type);
  response.with("Content-Disposition", "attachment; filename*=UTF-8''" + percent_encode(layer->slug + "." + (*format)->extension));
  add_sequences(response, at.value_or(snapshot->sequence), (*room)->durable_sequence());
  return response;
}

void write_texels(const RouteContext& context, const Request& request, const Respond& respond) {
  auto format = format_of(request);
  if (!format) return respond(format.error());
  auto room = context.rooms.open(request.param("model"));
  if (!room) return respond(room.error());
  auto layer = (*room)->layer(request.param("layer"));
  if (!layer) return respond(layer.error());
  std::vector<std::uint8_t> bytes(request.body_bytes);
  std::ifstream file(request.body_file, std::ios::binary);
  if (!file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size())))
    return respond(Problem{400, "Empty body", "Send the raster file as the body.", "body"});
  auto tiles = (*format)->decode(*layer, bytes);
  if (!tiles) return respond(tiles.error());
  room::EditRequest edit;
  edit.id = edit_id(request, *layer, "import");
  edit.user = request.user();
  edit.layer_id = layer->id;
  edit.record = {{"op", "import"}, {"format", (*format)->extension}, {"bytes", request.body_bytes}, {"sha256", sha256_hex({reinterpret_cast<const char*>(bytes.data()), bytes.size()})}};
  edit.edit = room::ImportEdit{std::move(*tiles)};
  apply_edit(context, request, *room, std::move(edit), respond);
}

}  // namespace

void add_texel_routes(Router& router, const RouteContext& context) {
  const std::string pattern = "/api/v1/models/{model}/layers/{layer}/texels.{format}";
  router.add({.method = Method::get,
              .pattern = pattern,
              .handler = answering([&context](const Request& request) { return read_texels(context, request); }),
              .query = {"at"}});
  router.add({.method = Method::put,
              .pattern = pattern,
              .handler = [&context](const Request& request, const Respond& respond) { write_texels(context, request, respond); },
              .role = Role::annotator,
              .body = BodyKind::file,
              .max_body = context.options.max_raster_bytes});
}

}  // namespace strata::net
