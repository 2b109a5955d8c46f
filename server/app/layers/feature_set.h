#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "query/maps/flat_area.h"

// What a layer has on its model, as programs for maps know it: areas, lines and points with
// attributes.
namespace strata::app {

using FeatureValue = std::variant<std::monostate, bool, std::int64_t, double, std::string>;

struct FeatureField {
  enum class Kind { boolean, integer, real, text };
  std::string name;  // in a table no other has it, also where case does not count
  Kind kind = Kind::text;
};

enum class FeatureKind { areas, lines, points };

struct Feature {
  std::vector<FeatureValue> values;  // one for each field
  // An area: any number of polygons. A line: one polygon of one ring, which is not closed. A point:
  // that with one place.
  std::vector<query::FlatPolygon> geometry;
};

// Features of one kind, with the same fields.
struct FeatureTable {
  FeatureKind kind = FeatureKind::areas;
  std::string name;  // "areas", "cracks": no other table of the set has it
  std::vector<FeatureField> fields;
  std::vector<Feature> features;
};

struct FeatureSet {
  std::string name;         // of the file, without its ending
  std::string description;  // "Layer Damage of Wall, along z, in mm"
  std::string unit;         // of the coordinates: "mm"
  std::string axes;         // which of the world's they are, in their order: "xyz"
  int epsg = 0;             // code of the coordinate system; 0: none that is known
  std::vector<FeatureTable> tables;
};

}  // namespace strata::app
