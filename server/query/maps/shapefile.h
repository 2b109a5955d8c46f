#pragma once

#include <span>
#include <string_view>

#include "query/maps/map_features.h"

namespace strata::query {

// The files of one shapefile. The index (.shx) is not needed: it is computed from the shapes.
struct ShapefileParts {
  std::span<const std::uint8_t> shp;
  std::span<const std::uint8_t> dbf;  // empty: no attributes
  // the texts' encoding, as a name or a number; empty: that of the .dbf, or detected
  std::string_view cpg;
  std::string_view prj;  // the coordinate system as WKT
};

bool is_shapefile(std::span<const std::uint8_t> bytes);  // by the first bytes of its .shp

// Reads the polygons (also with Z and M) of a shapefile with their attributes; shapes without a
// geometry and deleted records are skipped. shapelib reads them from memory, after lengths and
// counts were checked against the bytes in the files. Refused (invalid): other shapes, damaged or
// truncated files, files that do not belong together, and the limits of parse_geojson. Thread-safe.
Result<FeatureMap> parse_shapefile(const ShapefileParts& parts);

// "EPSG:25830" if the text ends with that authority; otherwise empty.
std::string epsg_of(std::string_view wkt);

}  // namespace strata::query
