#pragma once

#include <span>
#include <string_view>

#include "query/maps/map_features.h"

namespace strata::query {

// The files of one shapefile. The index (.shx) is not needed, because it is computed from the
// shapes.
struct ShapefileParts {
  std::span<const std::uint8_t> shp;
  std::span<const std::uint8_t> dbf;  // empty: no attributes
  // the encoding of the texts, as a name or a number; if empty, it is read from the .dbf or guessed
  std::string_view cpg;
  std::string_view prj;  // the coordinate system as WKT
};

bool is_shapefile(std::span<const std::uint8_t> bytes);  // checks the first bytes of the .shp

// Reads the polygons of a shapefile, also with Z and M, with their attributes. Skips shapes without
// a geometry and deleted records. Checks lengths and counts against the bytes in the files before
// shapelib reads these from memory. Returns an `invalid` error for other shapes, for damaged or
// truncated files, and for files that do not belong together. The limits of parse_geojson apply.
// Thread-safe.
Result<FeatureMap> parse_shapefile(const ShapefileParts& parts);

// Returns the authority at the end of the text, such as "EPSG:25830". Returns an empty text if
// there is no authority.
std::string epsg_of(std::string_view wkt);

}  // namespace strata::query
