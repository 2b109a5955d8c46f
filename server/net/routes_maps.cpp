// Maps and measurements, painted as one edit.
#include <charconv>

#include "core/mapped_file.h"
#include "core/picture.h"
#include "core/value_type.h"
#include "net/byte_budget.h"
#include "net/digest.h"
#include "net/routes.h"
#include "net/wire.h"
#include "query/flat_map.h"
#include "query/readings.h"

namespace strata::net {
namespace {

constexpr std::uint64_t kMaxMapBytes = 64u << 20;
constexpr int kLargestMapSide = 8192;
constexpr double kLargestLength_mm = 1e7;

// A number of the query; nothing where it is absent and `fallback` is not given.
Result<double> number_of(const Request& request, const std::string& name, double low, double high,
                         std::optional<double> fallback = {}) {
  const auto found = request.query.find(name);
  if (found == request.query.end()) {
    if (fallback) return *fallback;
    return fail(422, "Parameter missing", "Give `" + name + "`.", name);
  }
  double value = 0;
  const std::string& text = found->second;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !(value >= low && value <= high))
    return fail(422, "Parameter out of range", "`" + name + "` is a number in its range.", name);
  return value;
}

// The bits of a value in the layer; `where` tells what held it.
Result<std::uint32_t> bits_of(const Layer& layer, double value, const std::string& where) {
  auto bits = encode_value(layer.type, value);
  if (bits) return *bits;
  Problem problem = bits.error();
  problem.detail = where + problem.detail;
  problem.field = "body";
  return tl::unexpected(std::move(problem));
}

struct Axis {
  glm::dvec3 direction;
  int u, v;  // which of the world's coordinates the map's are
};

// "-z": seen from above, map coordinates are x and y; along y they are x and z, along x y and z.
Result<Axis> axis_of(const Request& request) {
  const auto found = request.query.find("along");
  const std::string text = found == request.query.end() ? "-z" : found->second;
  const int axis = text.size() == 2 ? text[1] - 'x' : -1;
  if (axis < 0 || axis > 2 || (text[0] != '-' && text[0] != '+'))
    return fail(422, "Unknown direction",
                "`along` is one of -x, +x, -y, +y, -z, +z: the way that the map is looked at.", "along");
  Axis made{glm::dvec3(0), axis == 0 ? 1 : 0, axis == 2 ? 1 : 2};
  made.direction[axis] = text[0] == '-' ? -1 : 1;
  return made;
}

struct Target {
  std::shared_ptr<room::Room> room;
  Layer layer;
  std::string_view body;
  ByteBudget& budget;  // of the memory that pictures take
};

// Runs `paint` for the layer that the path names; it returns the texels.
template <class Paint>
Handler painting(const RouteContext& context, std::shared_ptr<ByteBudget> budget, std::string op, Paint paint) {
  return [&context, budget = std::move(budget), op = std::move(op), paint](const Request& request,
                                                                           const Respond& respond) {
    auto room = context.rooms.open(request.param("model"));
    if (!room) return respond(room.error());
    auto layer = (*room)->layer(request.param("layer"));
    if (!layer) return respond(layer.error());
    const auto file = MappedFile::open(request.body_file);
    if (!file || file->bytes().empty())
      return respond(Problem{400, "Empty body", "Send the file as the body.", "body"});
    Result<TileMap> tiles = paint(request, Target{*room, *layer, file->view(), *budget});
    if (!tiles) return respond(tiles.error());
    room::EditRequest edit;
    edit.id = edit_id(request, *layer, op);
    edit.user = request.user();
    edit.layer_id = layer->id;
    edit.record = {{"op", "import"}, {"kind", op}, {"bytes", request.body_bytes}, {"sha256", sha256_hex(file->view())}};
    for (const auto& [name, value] : request.query) edit.record[name] = value;
    edit.edit = room::ImportEdit{std::move(*tiles), true};
    apply_edit(context, request, *room, std::move(edit), respond);
  };
}

Result<TileMap> paint_readings(const Request& request, const Target& target) {
  const auto radius_mm = number_of(request, "radius_mm", 1e-6, kLargestLength_mm);
  if (!radius_mm) return tl::unexpected(radius_mm.error());
  const auto tolerance_mm = number_of(request, "tolerance_mm", 0, kLargestLength_mm, *radius_mm);
  if (!tolerance_mm) return tl::unexpected(tolerance_mm.error());
  const auto readings = query::parse_readings(target.body);
  if (!readings) return tl::unexpected(readings.error());
  std::vector<room::Room::PlacedValue> values;
  for (const query::Reading& reading : *readings) {
    const auto bits = bits_of(target.layer, reading.value, "Line " + std::to_string(reading.line) + ": ");
    if (!bits) return tl::unexpected(bits.error());
    values.push_back({reading.position, *bits, reading.line});
  }
  const Unit unit = target.room->model().unit;
  return target.room->dabs(target.layer, values, in_model_units(*radius_mm, unit), in_model_units(*tolerance_mm, unit));
}

Result<TileMap> paint_polygons(const Request& request, const Target& target) {
  const auto axis = axis_of(request);
  if (!axis) return tl::unexpected(axis.error());
  const auto attribute = request.query.find("attribute");
  const bool by_attribute = attribute != request.query.end();
  if (by_attribute == request.query.contains("value"))
    return fail(422, "Parameter missing", "Give exactly one of `value` and `attribute`.", "value");
  const auto value = number_of(request, "value", -3.4028234663852886e38, 3.4028234663852886e38, 0.0);
  if (!value) return tl::unexpected(value.error());
  const auto areas = query::parse_map_areas(target.body, by_attribute ? attribute->second : std::string(), *value);
  if (!areas) return tl::unexpected(areas.error());
  for (const query::MapArea& area : *areas)
    if (auto bits = bits_of(target.layer, area.value, ""); !bits) return tl::unexpected(bits.error());
  const auto value_at = [&](const glm::dvec3& world) -> std::optional<std::uint32_t> {
    const auto found = query::value_at(*areas, {world[axis->u], world[axis->v]});
    if (!found) return std::nullopt;
    return *encode_value(target.layer.type, *found);
  };
  return target.room->project(target.layer, axis->direction, value_at);
}

Result<TileMap> paint_picture(const Request& request, const Target& target) {
  const auto axis = axis_of(request);
  if (!axis) return tl::unexpected(axis.error());
  const auto world_text = request.query.find("world");
  if (world_text == request.query.end())
    return fail(422, "Parameter missing", "Give `world`: the six numbers of the picture's world file.", "world");
  const auto world = query::parse_world_file(world_text->second, "world");
  if (!world) return tl::unexpected(world.error());
  for (const double luminance : {0.0, 255.0})
    if (auto bits = bits_of(target.layer, luminance, "Luminance is 0 to 255. "); !bits)
      return tl::unexpected(bits.error());
  const std::span<const std::uint8_t> bytes(reinterpret_cast<const std::uint8_t*>(target.body.data()),
                                            target.body.size());
  const auto info = inspect_picture(bytes, kLargestMapSide);
  if (!info) return tl::unexpected(info.error());
  const auto held =
      target.budget.take(std::uint64_t{4} * static_cast<unsigned>(info->width) * static_cast<unsigned>(info->height));
  if (!held) return tl::unexpected(held.error());
  auto picture = decode_picture(bytes, kLargestMapSide);
  if (!picture) return tl::unexpected(picture.error());
  const query::PlacedPicture placed(std::move(*picture), *world);
  const auto value_at = [&](const glm::dvec3& at) -> std::optional<std::uint32_t> {
    const auto luminance = placed.luminance_at({at[axis->u], at[axis->v]});
    if (!luminance) return std::nullopt;
    return *encode_value(target.layer.type, *luminance);
  };
  return target.room->project(target.layer, axis->direction, value_at);
}

}  // namespace

void add_map_routes(Router& router, const RouteContext& context) {
  const std::string layer = "/api/v1/models/{model}/layers/{layer}";
  const auto budget = std::make_shared<ByteBudget>(context.options.max_rasters_at_once);
  const auto add = [&](const std::string& name, Handler handler, std::vector<std::string> query) {
    router.add({.method = Method::post,
                .pattern = layer + "/" + name,
                .handler = std::move(handler),
                .role = Role::annotator,
                .query = std::move(query),
                .body = BodyKind::file,
                .max_body = kMaxMapBytes});
  };
  add("readings", painting(context, budget, "readings", paint_readings), {"radius_mm", "tolerance_mm"});
  add("polygons", painting(context, budget, "polygons", paint_polygons), {"along", "value", "attribute"});
  add("picture", painting(context, budget, "picture", paint_picture), {"along", "world"});
}

}  // namespace strata::net
