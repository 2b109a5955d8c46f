#include "app/maps/map_contents.h"

namespace strata::app {
namespace {

Result<MapContents> polygon_contents(const MapFiles& files, const Model& model) {
  const auto map = STRATA_TRY(features_of(files, model));
  MapContents::Polygons polygons;
  glm::dvec2 low(0), high(0);
  for (const query::MapFeature& feature : map.features)
    for (const auto& rings : feature.polygons) {
      for (const auto& ring : rings)
        for (const glm::dvec2& point : ring) {
          const bool is_first =
              polygons.count == 0 && &point == &feature.polygons.front().front().front();
          low = is_first ? point : glm::min(low, point);
          high = is_first ? point : glm::max(high, point);
        }
      ++polygons.count;
    }
  if (polygons.count == 0)
    return fail(ErrorCode::invalid, "No polygons", "The map contains no polygon.", "body");
  polygons.columns = query::columns_of(map);
  return MapContents{files.kind(), map.crs, std::pair(low, high), std::move(polygons)};
}

std::pair<glm::dvec2, glm::dvec2> bounds_of(const query::WorldFile& world, int width, int height) {
  glm::dvec2 low(0), high(0);
  for (int corner = 0; corner < 4; ++corner) {
    const double column = (corner & 1 ? width : 0) - 0.5, row = (corner & 2 ? height : 0) - 0.5;
    const glm::dvec2 at(world.x_per_column * column + world.x_per_row * row + world.x,
                        world.y_per_column * column + world.y_per_row * row + world.y);
    low = corner == 0 ? at : glm::min(low, at);
    high = corner == 0 ? at : glm::max(high, at);
  }
  return {low, high};
}

Result<MapContents> raster_contents(const MapFiles& files, const Model& model, double tolerance,
                                    ByteBudget& budget) {
  MapContents::Raster raster;
  raster.tiff = STRATA_TRY(tiff_of(files, model));
  const auto& tiff = raster.tiff;
  const auto held = STRATA_TRY(budget_of(files, tiff, budget));
  if (tiff) {
    raster.width = tiff->width;
    raster.height = tiff->height;
  }
  if (!tiff || tiff->has_colors) {
    const auto picture = STRATA_TRY(picture_of(files, tiff));
    raster.width = picture.width;
    raster.height = picture.height;
    raster.colors = query::find_colors(picture, tolerance);
  }
  MapContents contents{files.kind(), tiff ? tiff->crs : std::string(), {}, MapContents::Raster()};
  const auto world = world_of({}, files, tiff ? tiff->world : std::nullopt);
  // If the error is at another field, the world file is invalid.
  if (!world && world.error().field != "world") return tl::unexpected(world.error());
  if (world) {
    raster.world = *world;
    contents.bounds = bounds_of(*world, raster.width, raster.height);
  }
  contents.parts = std::move(raster);
  return contents;
}

}  // namespace

Result<MapContents> map_contents(const MapFiles& files, const Model& model, double tolerance,
                                 ByteBudget& budget) {
  const bool is_raster = files.kind() == MapKind::picture || files.kind() == MapKind::tiff;
  return is_raster ? raster_contents(files, model, tolerance, budget)
                   : polygon_contents(files, model);
}

}  // namespace strata::app
