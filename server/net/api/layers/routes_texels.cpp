#include <set>

#include "app/records/texel_csv.h"
#include "core/byte_budget.h"
#include "core/digest.h"
#include "core/mapped_file.h"
#include "core/text/bytes.h"
#include "domain/layers/layer.h"
#include "domain/layers/tile_mirror.h"
#include "domain/people/role.h"
#include "domain/tables/table.h"
#include "expression/expression_parser.h"
#include "net/api/addressed.h"
#include "net/api/route_help.h"
#include "net/api/routes.h"
#include "net/serialization/as_of.h"
#include "net/serialization/point_text.h"
#include "net/serialization/sheet_response.h"
#include "net/transport/server_options.h"
#include "query/rasters/raster.h"
#include "room/edit.h"
#include "room/edits.h"
#include "room/layers.h"
#include "room/queries.h"
#include "room/room.h"
#include "room/selection.h"
#include "store/store.h"
#include "store/tables/records.h"
#include "store/tables/tables.h"

namespace strata::net {
namespace {

// Bytes per texel of an imported file: a double and a validity byte.
constexpr std::uint64_t kTexelBytes = 9;
// The maximum size of a raster for the largest layer.
constexpr std::uint64_t kMaxRasterBytes = (16384ull * 16384 * kTexelBytes) + (1u << 20);

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
  return fail(ErrorCode::not_found, "Unknown raster format",
              "Request texels.tif, texels.png, texels.npy or texels.csv.", "format");
}

// The uncompressed size, including the plane with the validity. A TIFF stores this plane in the
// type of the values.
std::uint64_t raster_bytes(const Layer& layer) {
  return std::uint64_t(layer.resolution) * layer.resolution * 2 *
             std::uint64_t(bytes_per_texel(layer.type)) +
         (1u << 20);
}

Result<Response> read_texels(const RouteContext& context, ByteBudget& budget,
                             const Request& request) {
  auto format = STRATA_TRY(format_of(request));
  const auto query = STRATA_TRY(LayerQuery::from(context, request));
  auto held = STRATA_TRY(budget.take(raster_bytes(query.layer)));
  auto snapshot = query.room->queries().tiles(query.layer.slug, query.at);
  if (!snapshot) return tl::unexpected(snapshot.error());
  auto bytes = format->encode(query.layer, snapshot->tiles);
  if (!bytes) return tl::unexpected(bytes.error());
  Response response = bytes_response(std::move(*bytes), format->media_type);
  response.held = std::move(held);
  name_download(response, query.layer.slug + "." + format->extension);
  add_sequences(response, query.at.value_or(snapshot->sequence),
                query.room->edits().durable_sequence());
  return response;
}

Result<void> check_size(const Layer& layer, std::uint64_t bytes) {
  const std::uint64_t most =
      std::uint64_t(layer.resolution) * layer.resolution * kTexelBytes + (1u << 20);
  if (bytes <= most) return {};
  return fail(ErrorCode::too_large, "Raster too large",
              "A raster of this layer can have at most " + std::to_string(most) +
                  " bytes. Send a raster with the resolution of the layer.",
              "body");
}

// Checks the size before the body is read, if the request has a Content-Length.
Result<void> check_raster(const RouteContext& context, const Request& request) {
  STRATA_TRY(format_of(request));
  auto layer = STRATA_TRY(stored_layer(context, request));
  const std::string_view length = request.header("content-length");
  if (length.empty()) return {};
  auto bytes = STRATA_TRY(parse_integer(length, 0, INT64_MAX, "Content-Length"));
  return check_size(layer, static_cast<std::uint64_t>(bytes));
}

void write_texels(const RouteContext& context, ByteBudget& budget, const Request& request,
                  const Respond& respond) {
  auto format = format_of(request);
  if (!format) return respond(format.error());
  auto room = open_room(context, request);
  if (!room) return respond(room.error());
  auto layer = (*room)->layers().find(request.param("layer"));
  if (!layer) return respond(layer.error());
  if (auto fits = check_size(*layer, request.body_bytes); !fits) return respond(fits.error());
  auto held = budget.take(raster_bytes(*layer));
  if (!held) return respond(held.error());
  const auto file = MappedFile::open(request.body_file);
  if (!file || file->bytes().empty())
    return respond(Error{ErrorCode::malformed, "Empty body",
                         "The request has no body. Send the raster file as the body.", "body"});
  auto tiles = (*format)->decode(*layer, file->bytes());
  if (!tiles) return respond(tiles.error());
  room::EditRequest edit{edit_id(request, *layer, "import"), request.author(), layer->id};
  edit.record = {{"op", "import"},
                 {"format", (*format)->extension},
                 {"bytes", request.body_bytes},
                 {"sha256", sha256_hex(file->view())}};
  edit.edit = room::ImportEdit{std::move(*tiles)};
  apply_edit(context, request, *room, std::move(edit), respond);
}

// --- texels as lines of text

constexpr std::size_t kPieceBytes = 1u << 16;

std::vector<std::int64_t> keys_of(const query::SurfaceTexels& texels) {
  std::set<std::int64_t> keys;
  std::optional<std::uint32_t> last;  // adjacent texels mostly have the same key
  query::for_each_sample(texels, [&](const query::TexelSample& sample) {
    if (last != sample.bits) keys.insert(sample.bits);
    last = sample.bits;
    return true;
  });
  return {keys.begin(), keys.end()};
}

// Adds columns with values of the records that the keys refer to, at the sequence `at`.
Result<void> add_columns(const RouteContext& context, Role seen_by,
                         const std::vector<std::string>& column_refs,
                         const query::SurfaceTexels& texels, std::optional<std::int64_t> at,
                         app::TexelCsv& csv) {
  const Layer& layer = texels.view.layer;
  if (!layer.table)
    return fail(ErrorCode::invalid, "Numeric layer",
                layer.name + " stores numbers. Only layers of records have columns.", "columns");
  store::RecordQuery query;
  query.keys = keys_of(texels);
  if (at) {
    auto then = STRATA_TRY(context.store.tables().sequence_when(*layer.table, layer.model_id, *at));
    query.at = then;
  }
  auto page = STRATA_TRY(context.store.records().page(*layer.table, seen_by, query));
  std::vector<Column> columns;
  for (const std::string& ref : column_refs) {
    const Column* column = find_column(page.table.columns, ref);
    if (!column)
      return fail(ErrorCode::invalid, "Column not found",
                  page.table.name + " has no column `" + ref.substr(0, 100) + "`.", "columns");
    columns.push_back(*column);
  }
  csv.add_records(page.records, columns);
  return {};
}

Result<Response> read_texel_lines(const RouteContext& context, const Request& request) {
  const auto separator = STRATA_TRY(csv_separator(request));
  std::optional<double> cell_m;
  if (const auto given = request.query.find("cell"); given != request.query.end()) {
    auto length = parse_length(given->second, "cell");
    if (!length) return tl::unexpected(length.error());
    cell_m = *length;
  }
  room::Selection selection;
  if (const auto given = request.query.find("where"); given != request.query.end()) {
    auto condition = query::parse_condition(given->second, "where");
    if (!condition) return tl::unexpected(condition.error());
    selection.where = std::move(*condition);
  }
  const auto target = STRATA_TRY(LayerQuery::from(context, request));
  selection.at = target.at;
  auto found = target.room->queries().surface_texels(target.layer.slug, selection);
  if (!found) return tl::unexpected(found.error());
  const auto texels = std::make_shared<const query::SurfaceTexels>(std::move(*found));
  auto csv = std::make_shared<app::TexelCsv>(target.room->model().unit, separator);
  if (const auto column_refs = split_list(request.query_or("columns", {})); !column_refs.empty())
    STRATA_TRY(add_columns(context, request.role(), column_refs, *texels, target.at, *csv));
  std::shared_ptr<std::vector<query::TexelSample>> cells;
  if (cell_m) {
    auto summed = STRATA_TRY(query::samples_by_cell(*texels, *cell_m / texels->metres_per_unit));
    cells = std::make_shared<std::vector<query::TexelSample>>(std::move(summed));
  }
  Response response;
  response.with("Content-Type", kCsvType);
  name_download(response, target.layer.slug + ".csv");
  add_sequences(response, target.at.value_or(texels->view.snapshot.sequence),
                target.room->edits().durable_sequence());
  const auto write = [texels, csv, cells](const Response::Sink& sink) {
    std::string text = csv->head();
    const auto send = [&] {
      const bool sent = sink(bytes_of(text));
      text.clear();
      return sent;
    };
    bool goes_on = true;
    const auto put = [&](const query::TexelSample& sample) {
      csv->append(text, sample, cells != nullptr);
      if (text.size() >= kPieceBytes) goes_on = send();
      return goes_on;
    };
    if (cells) {
      for (const query::TexelSample& sample : *cells)
        if (!put(sample)) break;
    } else {
      query::for_each_sample(*texels, put);
    }
    return goes_on && send();
  };
  response.stream = Response::Stream{{}, write};
  return response;
}

}  // namespace

void add_texel_routes(Router& router, const RouteContext& context) {
  const std::string pattern = "/api/v1/models/{model}/layers/{layer}/texels.{format}";
  auto budget = std::make_shared<ByteBudget>(context.options.max_rasters_at_once);
  // The router needs this route before the route that accepts any extension.
  router.add({.method = Method::get,
              .pattern = "/api/v1/models/{model}/layers/{layer}/texels.csv",
              .handler = answering([&context](const Request& request) {
                return read_texel_lines(context, request);
              }),
              .query = {"where", "cell", "columns", "separator", "at"},
              .is_question = true,
              .state = state_of_model(context)});
  router.add({.method = Method::get,
              .pattern = pattern,
              .handler = answering([&context, budget](const Request& request) {
                return read_texels(context, *budget, request);
              }),
              .query = {"at"},
              .is_question = true,
              .state = state_of_model(context)});
  router.add(
      {.method = Method::put,
       .pattern = pattern,
       .handler = [&context, budget](
                      const Request& request,
                      const Respond& respond) { write_texels(context, *budget, request, respond); },
       .role = Role::annotator,
       .check = [&context](const Request& request) { return check_raster(context, request); },
       .body = BodyKind::file,
       .max_body = kMaxRasterBytes});
}

}  // namespace strata::net
