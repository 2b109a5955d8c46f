#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "query/maps/flat_area.h"

// The features of a layer on its model, as GIS programs define them: areas, lines and points with
// attributes.
namespace strata::app {

using FeatureValue = std::variant<std::monostate, bool, std::int64_t, double, std::string>;

struct FeatureField {
  enum class Kind { boolean, integer, real, text };
  std::string name;  // unique in its table, without regard to case
  Kind kind = Kind::text;
};

enum class FeatureKind { areas, lines, points };

struct Feature {
  std::vector<FeatureValue> values;  // one per field
  // An area: any number of polygons. A line: one polygon of one ring, which is not closed. A point:
  // one polygon of one ring with one point.
  std::vector<query::FlatPolygon> geometry;
};

// Features of one kind with the same fields.
struct FeatureTable {
  FeatureKind kind = FeatureKind::areas;
  std::string name;  // "areas", "cracks": unique in the set
  std::vector<FeatureField> fields;
  std::vector<Feature> features;
};

struct FeatureSet {
  std::string name;         // of the file, without the extension
  std::string description;  // "Layer Damage of Wall, along z, in mm"
  std::string unit;         // of the coordinates: "mm"
  std::string axes;         // the world axes of the coordinates, in their order: "xyz"
  int epsg = 0;             // code of the coordinate system; 0: unknown
  std::vector<FeatureTable> tables;
};

}  // namespace strata::app
