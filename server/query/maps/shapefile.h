#pragma once

#include <span>
#include <string_view>

#include "query/maps/map_features.h"

namespace strata::query {

// The files of one shapefile. Its index (.shx) is not needed: it is made from the shapes.
struct ShapefileParts {
  std::span<const std::uint8_t> shp;
  std::span<const std::uint8_t> dbf;  // empty: no attributes
  // the texts' encoding, as a name or a number; empty: what the dbf says, or what fits
  std::string_view cpg;
  std::string_view prj;  // the coordinate system as WKT
};

bool is_shapefile(std::span<const std::uint8_t> bytes);  // by the first bytes of its .shp

// The polygons (also with Z and M) of a shapefile with their attributes; shapes without a geometry
// and deleted records are passed over. Read by shapelib from memory, after lengths and counts are
// checked against the bytes that are there. Refused (invalid): other shapes, damaged or truncated
// files, files that do not belong together, as much as parse_geojson refuses. Thread-safe.
Result<FeatureMap> parse_shapefile(const ShapefileParts& parts);

// "EPSG:25830" where the text ends with that authority; empty elsewhere.
std::string epsg_of(std::string_view wkt);

}  // namespace strata::query
