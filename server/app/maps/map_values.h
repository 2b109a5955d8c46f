#pragma once

#include <functional>
#include <set>

#include "app/maps/map_place.h"
#include "core/byte_budget.h"
#include "query/maps/key_names.h"
#include "query/maps/map_features.h"
#include "room/room.h"

namespace strata::app {

// A map as numbers of one layer.
struct MapValues {
  // of the layer's type
  std::function<std::optional<std::uint32_t>(const glm::dvec2& place)> bits_at;
  std::optional<query::KeyNames> keys;  // of a categorical legend, with the map's additions
};

struct MapTarget {
  room::Room& room;
  const Layer& layer;
  std::set<double> records{};  // of a database layer: keys that are in use
};

// Reads GeoJSON or a shapefile, by `value`, or by `attribute` and `names` of the options.
Result<MapValues> polygon_values(const MapOptions& options, const MapFiles& files,
                                 const MapTarget& target, ByteBudget& budget);
// Reads polygons of any supported file, checked against the model's coordinates.
Result<query::FeatureMap> features_of(const MapFiles& files, const Model& model);

// Reads PNG, JPEG or TIFF, by `colors` with `tolerance`, or `band`, or neither: a TIFF's only band,
// otherwise the luminance.
Result<MapValues> picture_values(const MapOptions& options, const MapFiles& files,
                                 const MapTarget& target, ByteBudget& budget);

// A picture in colors with its position.
struct MapPicture {
  Picture picture;
  query::WorldFile world;
  std::shared_ptr<const void> held;  // reserved part of the budget
};
// Reads the header of a TIFF, checked against the model's coordinates; nothing: another format.
Result<std::optional<query::MapTiff>> tiff_of(const MapFiles& files, const Model& model);
Result<Picture> picture_of(const MapFiles& files, const std::optional<query::MapTiff>& tiff);
// Reserves memory of the budget before decoding.
Result<std::shared_ptr<const void>> budget_of(const MapFiles& files,
                                              const std::optional<query::MapTiff>& tiff,
                                              ByteBudget& budget);
// Reads the whole picture, with the position from `world_of`. Refuses polygons (415).
Result<MapPicture> map_picture(const MapOptions& options, const MapFiles& files, const Model& model,
                               ByteBudget& budget);

constexpr double kMinTolerance = 1, kMaxTolerance = 60;  // of colors

}  // namespace strata::app
