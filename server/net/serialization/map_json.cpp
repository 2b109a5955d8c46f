#include "net/serialization/map_json.h"

#include <cstdio>

#include "core/overloaded.h"
#include "domain/layers/value_type.h"

namespace strata::net {
namespace {

nlohmann::json json_of(const app::MapContents::Polygons& polygons, app::MapKind kind) {
  nlohmann::json columns = nlohmann::json::array();
  for (const query::MapColumn& column : polygons.columns)
    columns.push_back({{"name", column.name},
                       {"type", column.is_number ? "number"
                                : column.is_text ? "text"
                                                 : "mixed"},
                       {"samples", column.samples}});
  return {{"kind", "polygons"},
          {"format", kind == app::MapKind::shapefile ? "shapefile" : "geojson"},
          {"polygons", polygons.count},
          {"columns", std::move(columns)}};
}

nlohmann::json json_of(const app::MapContents::Raster& raster) {
  nlohmann::json json{{"kind", "picture"},
                      {"format", raster.tiff ? "tiff" : "picture"},
                      {"colors", nlohmann::json::array()},
                      {"width", raster.width},
                      {"height", raster.height},
                      {"has_colors", !raster.tiff || raster.tiff->has_colors},
                      {"is_rgb", !raster.tiff || raster.tiff->is_rgb}};
  for (const query::FoundColor& found : raster.colors)
    json["colors"].push_back({{"color", rgb_text(found.color)},
                              {"share", found.share},
                              {"background", found.is_background}});
  if (raster.tiff) {
    if (raster.tiff->has_numbers) json["bands"] = raster.tiff->bands;
    if (raster.tiff->has_numbers) json["type"] = name(raster.tiff->type);
    if (raster.tiff->nodata) json["nodata"] = *raster.tiff->nodata;
  }
  if (const auto& world = raster.world)
    json["world"] = {world->x_per_column,
                     world->y_per_column,
                     world->x_per_row,
                     world->y_per_row,
                     world->x,
                     world->y};
  return json;
}

}  // namespace

nlohmann::json to_json(const app::MapContents& contents) {
  nlohmann::json json =
      std::visit(Overloaded{[&](const app::MapContents::Polygons& polygons) {
                              return json_of(polygons, contents.kind);
                            },
                            [](const app::MapContents::Raster& raster) { return json_of(raster); }},
                 contents.parts);
  if (contents.bounds) {
    const auto& [low, high] = *contents.bounds;
    json["bounds"] = {low.x, low.y, high.x, high.y};
  }
  if (!contents.crs.empty()) json["crs"] = contents.crs;
  return json;
}

}  // namespace strata::net
