#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "query/maps/flat_area.h"

// The features of a layer on its model, as in GIS programs. They are areas, lines and points with
// attributes.
namespace strata::app {

using FeatureValue = std::variant<std::monostate, bool, std::int64_t, double, std::string>;

struct FeatureField {
  enum class Kind { boolean, integer, real, text };
  std::string name;  // unique in its table; case does not matter
  Kind kind = Kind::text;
  std::vector<std::string> choices{};  // the possible texts of an enumeration
  std::string title{}, unit{};         // of a column, for people; empty: none
};

enum class FeatureKind { areas, lines, points };

struct Feature {
  std::string id;                    // unique in its table, and the same until the record changes
  std::vector<FeatureValue> values;  // one value per field
  // An area consists of any number of polygons. A line is one polygon with one open ring. A point
  // is one polygon with one ring that consists of one point.
  std::vector<query::FlatPolygon> geometry;
};

// Features of the same kind with the same fields.
struct FeatureTable {
  FeatureKind kind = FeatureKind::areas;
  std::string name;  // "areas", "cracks": unique in the set
  std::vector<FeatureField> fields;
  std::vector<Feature> features;
};

struct FeatureSet {
  std::string name;         // file name without the extension
  std::string description;  // "Layer Damage of Wall, along z, in mm"
  std::string unit;         // unit of the coordinates: "mm"
  std::string axes;         // world axes of the coordinates, in order: "xyz"
  int epsg = 0;             // code of the coordinate system; 0 if unknown
  std::vector<FeatureTable> tables;
};

}  // namespace strata::app
