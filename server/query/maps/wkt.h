#pragma once

#include <string>
#include <vector>

#include "core/error.h"
#include "query/maps/flat_area.h"

namespace strata::query {

// A geometry in well-known text. A point is one polygon with one ring of one corner, and a line one
// polygon with one open ring.
struct WktGeometry {
  enum class Kind { points, line, areas };
  Kind kind = Kind::points;
  bool has_heights = false;
  std::vector<FlatPolygon> parts;
};

// Parses POINT, MULTIPOINT, LINESTRING, POLYGON or MULTIPOLYGON, with or without Z, with GEOS.
// Refuses (malformed, at `field`) other text, empty geometries, and numbers that are not finite.
Result<WktGeometry> parse_wkt(const std::string& text, const std::string& field);

}  // namespace strata::query
