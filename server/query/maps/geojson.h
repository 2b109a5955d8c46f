#pragma once

#include <string_view>

#include "query/maps/map_features.h"

namespace strata::query {

// Parses the polygons of a GeoJSON text (RFC 7946: a FeatureCollection, a Feature or a geometry of
// Polygons and MultiPolygons), in their order. Reads the properties that are numbers, texts, or
// true and false (as 1 and 0). Skips features without a geometry, and coordinates after x and y.
// Returns a `malformed` error for text that is not JSON. Returns an `invalid` error with the path
// for other JSON, for points and lines, and for rings of fewer than three points. Texts with more
// than kMaxMapPoints, kMaxMapFeatures or kMaxMapColumns are `invalid`, too.
Result<FeatureMap> parse_geojson(std::string_view text);

}  // namespace strata::query
