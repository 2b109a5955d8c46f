// Routes that paint a map or measurements as one edit.
#include "app/maps/map_contents.h"
#include "app/maps/map_legend.h"
#include "app/maps/map_values.h"
#include "app/records/painted_keys.h"
#include "core/byte_budget.h"
#include "core/digest.h"
#include "core/mapped_file.h"
#include "domain/layers/layer.h"
#include "domain/layers/tile_mirror.h"
#include "domain/layers/value_type.h"
#include "domain/people/role.h"
#include "domain/scene/model.h"
#include "domain/scene/units.h"
#include "domain/tables/table.h"
#include "net/api/addressed.h"
#include "net/api/route_help.h"
#include "net/api/routes.h"
#include "net/serialization/map_json.h"
#include "net/serialization/map_query.h"
#include "net/transport/server_options.h"
#include "query/maps/point_measurements.h"
#include "room/edit.h"
#include "room/layers.h"
#include "room/room.h"
#include "room/surface.h"
#include "store/store.h"
#include "store/tables/records.h"

namespace strata::net {
namespace {

constexpr double kMaxLength_mm = 1e7;

struct Painted {
  TileMap tiles;
  nlohmann::json record;  // description of the input for the journal
};

struct Target {
  std::shared_ptr<room::Room> room;
  Layer layer;
};

// Runs `paint` for the layer in the path.
template <class Paint>
Handler painting(const RouteContext& context, const std::string& op, Paint paint) {
  return [&context, op, paint](const Request& request, const Respond& respond) {
    auto room = open_room(context, request);
    if (!room) return respond(room.error());
    auto layer = (*room)->layers().find(request.param("layer"));
    if (!layer) return respond(layer.error());
    Result<Painted> painted = paint(request, Target{*room, *layer});
    if (!painted) return respond(painted.error());
    room::EditRequest edit{edit_id(request, *layer, op), request.author(), layer->id};
    edit.record = {{"op", "import"}, {"kind", op}};
    edit.record.update(painted->record);
    for (const auto& [name, value] : request.query) edit.record[name] = value;
    edit.edit = room::ImportEdit{std::move(painted->tiles), true};
    // Finds the layer again because its legend now contains the names from the map.
    const auto named = (*room)->layers().find(to_string(layer->id));
    if (!named) return respond(named.error());
    if (auto made = app::records_from_legend(context, *named, room::painted_by(*named, edit),
                                             request.author());
        !made)
      return respond(made.error());
    apply_edit(context, request, *room, std::move(edit), respond);
  };
}

Result<Painted> paint_point_measurements(const Request& request, const Target& target) {
  const auto file = MappedFile::open(request.body_file);
  if (!file || file->bytes().empty())
    return fail(ErrorCode::malformed, "Empty body",
                "The request has no body. Send the file as the body.", "body");
  const auto radius_mm = STRATA_TRY(number_of(request, "radius_mm", 1e-6, kMaxLength_mm));
  const auto tolerance_mm =
      STRATA_TRY(number_of(request, "tolerance_mm", 0, kMaxLength_mm, radius_mm));
  const auto measurements = STRATA_TRY(query::parse_point_measurements(file->view()));
  std::vector<room::PlacedValue> values;
  for (const query::PointMeasurement& measurement : measurements) {
    const auto bits = app::bits_of(target.layer, measurement.value,
                                   "Line " + std::to_string(measurement.line) + ": ");
    if (!bits) return tl::unexpected(bits.error());
    values.push_back({measurement.position, *bits, measurement.line});
  }
  const Unit unit = target.room->model().unit;
  auto tiles = target.room->surface().point_splats(
      target.layer, values, in_model_units(radius_mm, unit), in_model_units(tolerance_mm, unit));
  if (!tiles) return tl::unexpected(tiles.error());
  return Painted{std::move(*tiles),
                 {{"bytes", request.body_bytes}, {"sha256", sha256_hex(file->view())}}};
}

// Returns the values that a map paints at each position, and the keys that the map adds to the
// layer's legend.
using MakeValues = Result<app::MapValues> (*)(const app::MapOptions& options,
                                              const app::MapFiles& files,
                                              const app::MapTarget& target, ByteBudget& budget);

Result<Painted> paint_map(const RouteContext& context, ByteBudget& budget, MakeValues make,
                          const Request& request, const Target& target) {
  const auto axis = STRATA_TRY(map_axis(request));
  const auto options = STRATA_TRY(map_options(request));
  auto files = STRATA_TRY(take_map(request, context.options.upload_dir));
  app::MapTarget map_target{*target.room, target.layer};
  if (target.layer.table) {
    auto page = STRATA_TRY(context.store.records().page(*target.layer.table, request.role(),
                                                        {{}, {}, {}, store::kMaxRecords, 0}));
    for (const Record& record : page.records)
      map_target.records.insert(static_cast<double>(record.key));
  }
  auto values = STRATA_TRY(make(options, files, map_target, budget));
  auto tiles = target.room->surface().project(
      target.layer, axis.direction,
      [&](const glm::dvec3& world) { return values.bits_at(axis.on_map(world)); });
  if (!tiles) return tl::unexpected(tiles.error());
  if (values.keys)
    if (auto extended =
            app::extend_legend(request.role(), *target.room, target.layer, *values.keys);
        !extended)
      return tl::unexpected(extended.error());
  return Painted{std::move(*tiles), files.record()};
}

Result<Response> map_contents(const RouteContext& context, ByteBudget& budget,
                              const Request& request) {
  const auto model = STRATA_TRY(stored_model(context, request));
  const auto options = STRATA_TRY(map_options(request));
  const auto files = STRATA_TRY(take_map(request, context.options.upload_dir));
  return json_response(
      to_json(STRATA_TRY(app::map_contents(files, model, options.tolerance, budget))));
}

}  // namespace

void add_map_routes(Router& router, const RouteContext& context) {
  const std::string model = "/api/v1/models/{model}", layer = model + "/layers/{layer}";
  const auto budget = std::make_shared<ByteBudget>(context.options.max_rasters_at_once);
  const auto add = [&](const std::string& pattern, Handler handler,
                       std::vector<std::string> query) {
    router.add({.method = Method::post,
                .pattern = pattern,
                .handler = std::move(handler),
                .role = Role::annotator,
                .query = std::move(query),
                .body = BodyKind::file,
                .max_body = kMaxMapBytes,
                .is_long_edit = true});
  };
  const auto map = [&](MakeValues make) {
    return [&context, budget, make](const Request& request, const Target& target) {
      return paint_map(context, *budget, make, request, target);
    };
  };
  add(layer + "/readings", painting(context, "readings", paint_point_measurements),
      {"radius_mm", "tolerance_mm"});
  add(layer + "/polygons", painting(context, "polygons", map(app::polygon_values)),
      {"along", "value", "attribute", "names", "crs"});
  add(layer + "/picture", painting(context, "picture", map(app::picture_values)),
      {"along", "world", "band", "colors", "tolerance", "crs"});
  add(model + "/map-contents", answering([&context, budget](const Request& request) {
        return map_contents(context, *budget, request);
      }),
      {"tolerance"});
}

}  // namespace strata::net
