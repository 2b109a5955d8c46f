#include "net/map_contents.h"

#include <cstdio>

#include "core/value_type.h"
#include "net/map_values.h"
#include "query/color_keys.h"

namespace strata::net {
namespace {

std::string hex(const Rgba& color) {
  char text[8];
  std::snprintf(text, sizeof text, "#%02x%02x%02x", color[0], color[1], color[2]);
  return text;
}

Result<Response> polygon_contents(const MapFiles& files, const Model& model) {
  const auto map = STRATA_TRY(features_of(files, model));
  std::size_t count = 0;
  glm::dvec2 low(0), high(0);
  for (const query::MapFeature& feature : map.features)
    for (const auto& rings : feature.polygons) {
      for (const auto& ring : rings)
        for (const glm::dvec2& point : ring) {
          const bool is_first = count == 0 && &point == &feature.polygons.front().front().front();
          low = is_first ? point : glm::min(low, point);
          high = is_first ? point : glm::max(high, point);
        }
      ++count;
    }
  if (count == 0)
    return fail(ErrorCode::invalid, "No polygons", "The map holds no polygon.", "body");
  nlohmann::json columns = nlohmann::json::array();
  for (const query::MapColumn& column : query::columns_of(map))
    columns.push_back({{"name", column.name},
                       {"type", column.is_number ? "number"
                                : column.is_text ? "text"
                                                 : "mixed"},
                       {"samples", column.samples}});
  nlohmann::json json{{"kind", "polygons"},
                      {"format", files.kind() == MapKind::shapefile ? "shapefile" : "geojson"},
                      {"polygons", count},
                      {"columns", std::move(columns)},
                      {"bounds", {low.x, low.y, high.x, high.y}}};
  if (!map.crs.empty()) json["crs"] = map.crs;
  return json_response(json);
}

void add_world(nlohmann::json& json, const query::WorldFile& world, int width, int height) {
  json["world"] = {
      world.x_per_column, world.y_per_column, world.x_per_row, world.y_per_row, world.x, world.y};
  glm::dvec2 low(0), high(0);
  for (int corner = 0; corner < 4; ++corner) {
    const double column = (corner & 1 ? width : 0) - 0.5, row = (corner & 2 ? height : 0) - 0.5;
    const glm::dvec2 at(world.x_per_column * column + world.x_per_row * row + world.x,
                        world.y_per_column * column + world.y_per_row * row + world.y);
    low = corner == 0 ? at : glm::min(low, at);
    high = corner == 0 ? at : glm::max(high, at);
  }
  json["bounds"] = {low.x, low.y, high.x, high.y};
}

Result<Response> picture_contents(const Request& request, const MapFiles& files, const Model& model,
                                  double tolerance, ByteBudget& budget) {
  const auto tiff = STRATA_TRY(tiff_of(files, model));
  const auto held = STRATA_TRY(budget_of(files, tiff, budget));
  nlohmann::json json{{"kind", "picture"},
                      {"format", tiff ? "tiff" : "picture"},
                      {"colors", nlohmann::json::array()}};
  int width = tiff ? tiff->width : 0, height = tiff ? tiff->height : 0;
  if (!tiff || tiff->has_colors) {
    const auto picture = STRATA_TRY(picture_of(files, tiff));
    width = picture.width;
    height = picture.height;
    for (const query::FoundColor& found : query::find_colors(picture, tolerance))
      json["colors"].push_back({{"color", hex(found.color)},
                                {"share", found.share},
                                {"background", found.is_background}});
  }
  json["width"] = width;
  json["height"] = height;
  json["has_colors"] = !tiff || tiff->has_colors;
  json["is_rgb"] = !tiff || tiff->is_rgb;
  if (tiff) {
    if (tiff->has_numbers) json["bands"] = tiff->bands;
    if (tiff->has_numbers) json["type"] = name(tiff->type);
    if (tiff->nodata) json["nodata"] = *tiff->nodata;
    if (!tiff->crs.empty()) json["crs"] = tiff->crs;
  }
  const auto world = world_of(request, files, tiff ? tiff->world : std::nullopt);
  if (world) add_world(json, *world, width, height);
  // a world file that is none
  if (!world && world.error().field != "world") return tl::unexpected(world.error());
  return json_response(json);
}

}  // namespace

Result<Response> map_contents(const RouteContext& context, ByteBudget& budget,
                              const Request& request) {
  const auto model = STRATA_TRY(context.store.model(request.param("model")));
  const auto tolerance =
      number_of(request, "tolerance", kLeastTolerance, kMostTolerance, query::kUsualTolerance);
  if (!tolerance) return tl::unexpected(tolerance.error());
  const auto files = STRATA_TRY(MapFiles::take(request, context.options.upload_dir));
  const bool is_picture = files.kind() == MapKind::picture || files.kind() == MapKind::tiff;
  return is_picture ? picture_contents(request, files, model, *tolerance, budget)
                    : polygon_contents(files, model);
}

}  // namespace strata::net
