#pragma once

#include <functional>
#include <set>

#include "app/maps/map_place.h"
#include "core/byte_budget.h"
#include "query/maps/key_names.h"
#include "query/maps/map_features.h"
#include "room/room.h"

namespace strata::app {

// The values of a map for one layer.
struct MapValues {
  // Values in the type of the layer.
  std::function<std::optional<std::uint32_t>(const glm::dvec2& place)> bits_at;
  std::optional<query::KeyNames> keys;  // keys of a categorical legend, with additions from the map
};

struct MapTarget {
  room::Room& room;
  const Layer& layer;
  std::set<double> records{};  // keys in use, for a database layer
};

// Reads GeoJSON or a shapefile. Uses `value`, or `attribute` and `names`, of the options.
Result<MapValues> polygon_values(const MapOptions& options, const MapFiles& files,
                                 const MapTarget& target, ByteBudget& budget);
// Reads polygons from any supported file. Checks them against the coordinates of the model.
Result<query::FeatureMap> features_of(const MapFiles& files, const Model& model);

// Reads PNG, JPEG or TIFF. Uses `colors` with `tolerance`, or `band`, of the options. Without them,
// uses the only band of a TIFF, or the luminance.
Result<MapValues> picture_values(const MapOptions& options, const MapFiles& files,
                                 const MapTarget& target, ByteBudget& budget);

// A color image with its position.
struct MapPicture {
  Picture picture;
  query::WorldFile world;
  std::shared_ptr<const void> held;  // reserved memory of the budget
};
// Reads the header of a TIFF and checks it against the coordinates of the model. Returns nothing
// for another format.
Result<std::optional<query::MapTiff>> tiff_of(const MapFiles& files, const Model& model);
Result<Picture> picture_of(const MapFiles& files, const std::optional<query::MapTiff>& tiff);
// Reserves memory of the budget before the image is decoded.
Result<std::shared_ptr<const void>> budget_of(const MapFiles& files,
                                              const std::optional<query::MapTiff>& tiff,
                                              ByteBudget& budget);
// Reads the whole image, with the position from `world_of`. Refuses polygons (415).
Result<MapPicture> map_picture(const MapOptions& options, const MapFiles& files, const Model& model,
                               ByteBudget& budget);

constexpr double kMinTolerance = 1, kMaxTolerance = 60;  // when comparing colors

}  // namespace strata::app
