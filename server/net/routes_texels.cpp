#include "core/mapped_file.h"
#include "net/as_of.h"
#include "net/byte_budget.h"
#include "net/digest.h"
#include "net/routes.h"
#include "net/sheet.h"
#include "query/raster.h"

namespace strata::net {
namespace {

constexpr std::uint64_t kMaxRasterBytes = (16384ull * 16384 * 2 * 4) + (1u << 20);  // of the largest layer

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

// Uncompressed, with the valid plane; TIFF keeps that in the value's type, too.
std::uint64_t raster_bytes(const Layer& layer) {
  return std::uint64_t(layer.resolution) * layer.resolution * 2 * std::uint64_t(bytes_per_texel(layer.type)) +
         (1u << 20);
}

Result<Response> read_texels(const RouteContext& context, ByteBudget& budget, const Request& request) {
  auto format = format_of(request);
  if (!format) return tl::unexpected(format.error());
  auto room = context.rooms.open(request.param("model"));
  if (!room) return tl::unexpected(room.error());
  auto layer = (*room)->layer(request.param("layer"));
  if (!layer) return tl::unexpected(layer.error());
  const auto at = find_sequence(context, **room, as_of(request));
  if (!at) return tl::unexpected(at.error());
  auto held = budget.take(raster_bytes(*layer));
  if (!held) return tl::unexpected(held.error());
  auto snapshot = (*room)->tiles(layer->slug, *at);
  if (!snapshot) return tl::unexpected(snapshot.error());
  auto bytes = (*format)->encode(*layer, snapshot->tiles);
  if (!bytes) return tl::unexpected(bytes.error());
  Response response = bytes_response(std::move(*bytes), (*format)->media_type);
  response.held = std::move(*held);
  name_download(response, layer->slug + "." + (*format)->extension);
  add_sequences(response, at->value_or(snapshot->sequence), (*room)->durable_sequence());
  return response;
}

Result<void> check_size(const Layer& layer, std::uint64_t bytes) {
  if (bytes <= raster_bytes(layer)) return {};
  return fail(413, "Raster too large",
              "A raster of this layer has at most " + std::to_string(raster_bytes(layer)) + " bytes.", "body");
}

// Before the body, where its length is told.
Result<void> check_raster(const RouteContext& context, const Request& request) {
  auto format = format_of(request);
  if (!format) return tl::unexpected(format.error());
  auto model = context.store.model(request.param("model"));
  if (!model) return tl::unexpected(model.error());
  auto layer = context.store.layer(model->id, request.param("layer"));
  if (!layer) return tl::unexpected(layer.error());
  const std::string_view length = request.header("content-length");
  if (length.empty()) return {};
  auto bytes = parse_integer(length, 0, INT64_MAX, "Content-Length");
  if (!bytes) return tl::unexpected(bytes.error());
  return check_size(*layer, static_cast<std::uint64_t>(*bytes));
}

void write_texels(const RouteContext& context, ByteBudget& budget, const Request& request, const Respond& respond) {
  auto format = format_of(request);
  if (!format) return respond(format.error());
  auto room = context.rooms.open(request.param("model"));
  if (!room) return respond(room.error());
  auto layer = (*room)->layer(request.param("layer"));
  if (!layer) return respond(layer.error());
  if (auto fits = check_size(*layer, request.body_bytes); !fits) return respond(fits.error());
  auto held = budget.take(raster_bytes(*layer));
  if (!held) return respond(held.error());
  const auto file = MappedFile::open(request.body_file);
  if (!file || file->bytes().empty())
    return respond(Problem{400, "Empty body", "Send the raster file as the body.", "body"});
  auto tiles = (*format)->decode(*layer, file->bytes());
  if (!tiles) return respond(tiles.error());
  room::EditRequest edit;
  edit.id = edit_id(request, *layer, "import");
  edit.user = request.user();
  edit.layer_id = layer->id;
  edit.record = {{"op", "import"},
                 {"format", (*format)->extension},
                 {"bytes", request.body_bytes},
                 {"sha256", sha256_hex(file->view())}};
  edit.edit = room::ImportEdit{std::move(*tiles)};
  apply_edit(context, request, *room, std::move(edit), respond);
}

}  // namespace

void add_texel_routes(Router& router, const RouteContext& context) {
  const std::string pattern = "/api/v1/models/{model}/layers/{layer}/texels.{format}";
  auto budget = std::make_shared<ByteBudget>(context.options.max_rasters_at_once);
  router.add({.method = Method::get,
              .pattern = pattern,
              .handler = answering(
                  [&context, budget](const Request& request) { return read_texels(context, *budget, request); }),
              .query = {"at"}});
  router.add(
      {.method = Method::put,
       .pattern = pattern,
       .handler = [&context, budget](const Request& request,
                                     const Respond& respond) { write_texels(context, *budget, request, respond); },
       .role = Role::annotator,
       .check = [&context](const Request& request) { return check_raster(context, request); },
       .body = BodyKind::file,
       .max_body = kMaxRasterBytes});
}

}  // namespace strata::net
