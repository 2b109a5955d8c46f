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
  std::optional<query::KeyNames> keys;  // of a categorical legend, with what the map adds
};

struct MapTarget {
  room::Room& room;
  const Layer& layer;
  std::set<double> records{};  // of a database layer: keys that stand for something already
};

// GeoJSON or a shapefile, by `value`, or by `attribute` and `names` of the options.
Result<MapValues> polygon_values(const MapOptions& options, const MapFiles& files,
                                 const MapTarget& target, ByteBudget& budget);
// Whatever file the polygons are in, checked against the model's coordinates.
Result<query::FeatureMap> features_of(const MapFiles& files, const Model& model);

// PNG, JPEG or TIFF, by `colors` with `tolerance`, or `band`, or neither: a TIFF's only band, else
// the luminance.
Result<MapValues> picture_values(const MapOptions& options, const MapFiles& files,
                                 const MapTarget& target, ByteBudget& budget);

// A picture in colours with its place.
struct MapPicture {
  Picture picture;
  query::WorldFile world;
  std::shared_ptr<const void> held;  // of the budget
};
// What the header tells of a TIFF, checked against the model's coordinates; nothing: it is none.
Result<std::optional<query::MapTiff>> tiff_of(const MapFiles& files, const Model& model);
Result<Picture> picture_of(const MapFiles& files, const std::optional<query::MapTiff>& tiff);
// Takes its share of the budget before anything is decoded.
Result<std::shared_ptr<const void>> budget_of(const MapFiles& files,
                                              const std::optional<query::MapTiff>& tiff,
                                              ByteBudget& budget);
// The whole of it, as `world_of` finds its place. Refused (415): polygons.
Result<MapPicture> map_picture(const MapOptions& options, const MapFiles& files, const Model& model,
                               ByteBudget& budget);

constexpr double kMinTolerance = 1, kMaxTolerance = 60;  // of colours

}  // namespace strata::app
