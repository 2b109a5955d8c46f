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

// Maps of polygons with attributes, from any file format. Coordinates are coordinates of the plane,
// in model units.

constexpr std::size_t kMaxMapPoints = 2'000'000;
constexpr std::size_t kMaxMapFeatures = 500'000;
constexpr std::size_t kMaxMapColumns = 256;
constexpr std::size_t kMaxMapValues = 8'000'000;  // columns times features
// bytes of a name; columns with longer names are skipped
constexpr std::size_t kMaxMapColumnLength = 200;
std::string too_many_values();  // the message for a map with too many values

// Nothing, a number or a text.
using MapValue = std::variant<std::monostate, double, std::string>;

std::string number_text(double value);  // shortest text for exactly this number

struct MapFeature {
  using Rings = std::vector<std::vector<glm::dvec2>>;
  std::vector<Rings> polygons;   // each hole is also a ring
  std::vector<MapValue> values;  // sorted like the columns; the last values may be missing
  std::string place;  // position in the file, for messages: "body.features[3]", "Record 4"
};

struct FeatureMap {
  std::vector<std::string> columns;
  std::vector<MapFeature> features;
  std::string crs;          // such as "EPSG:25830"; empty if the file does not name it
  bool in_degrees = false;  // according to the file, its coordinates are longitude and latitude
};

// A column that a user can choose.
struct MapColumn {
  std::string name;
  bool is_number = false;  // every feature has a number
  bool is_text = false;    // every feature has a text that is not empty
  // distinct values in the order of first appearance, at most kMaxSamples
  std::vector<std::string> samples;
};
constexpr std::size_t kMaxSamples = 12;
std::vector<MapColumn> columns_of(const FeatureMap& map);

// The source of the values of areas.
struct MapChoice {
  std::string attribute;  // numbers or names of keys; if empty, all areas get `value`
  double value = 0;
  // the attribute with the names of the numbers; empty if there are no names
  std::string names;
};
// Returns the areas with their values; later areas are on top. Names become keys in `keys`; if
// `keys` is null, names are an `invalid` error. An unknown attribute, a feature without the
// attribute, and a map without areas are `invalid`, too.
Result<FlatMap> flat_map(const FeatureMap& map, const MapChoice& choice, KeyNames* keys);

}  // namespace strata::query
