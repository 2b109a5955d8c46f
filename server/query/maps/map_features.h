#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <variant>
#include <vector>

#include "core/error.h"
#include "query/maps/flat_map.h"
#include "query/maps/key_names.h"

namespace strata::query {

// Maps of polygons with attributes, from any file format. Coordinates are the plane's, in model
// units.

constexpr std::size_t kMaxMapPoints = 2'000'000;
constexpr std::size_t kMaxMapFeatures = 500'000;
constexpr std::size_t kMaxMapColumns = 256;
constexpr std::size_t kMaxMapValues = 8'000'000;  // columns times features
constexpr std::size_t kMaxMapColumnLength = 200;  // bytes of a name; longer ones are skipped
std::string too_many_values();                    // the message for a map with more values

// Nothing, a number or a text.
using MapValue = std::variant<std::monostate, double, std::string>;

std::string number_text(double value);  // as short as possible and unique

struct MapFeature {
  using Rings = std::vector<std::vector<glm::dvec2>>;
  std::vector<Rings> polygons;   // holes are rings like the others
  std::vector<MapValue> values;  // by columns; there may be fewer
  std::string place;             // in the file, for messages: "body.features[3]", "Record 4"
};

struct FeatureMap {
  std::vector<std::string> columns;
  std::vector<MapFeature> features;
  std::string crs;          // "EPSG:25830" where the file names it
  bool in_degrees = false;  // the file says that its coordinates are longitude and latitude
};

// A column that a person can choose.
struct MapColumn {
  std::string name;
  bool is_number = false;  // every feature has a number
  bool is_text = false;    // every feature has a text that is not empty
  // distinct values in the order of first appearance, kMaxSamples at most
  std::vector<std::string> samples;
};
constexpr std::size_t kMaxSamples = 12;
std::vector<MapColumn> columns_of(const FeatureMap& map);

// The choice of the areas' values.
struct MapChoice {
  std::string attribute;  // a number or the name of a key; empty: `value` for all
  double value = 0;
  // the attribute with the names of the numbers; empty: no names
  std::string names;
};
// Returns the areas with their values, later ones on top. Names become keys in `keys`; null: names
// are refused. Refused (invalid): an unknown attribute, a feature without it, no area at all.
Result<FlatMap> flat_map(const FeatureMap& map, const MapChoice& choice, KeyNames* keys);

}  // namespace strata::query
