#pragma once

#include <string_view>

#include "query/maps/map_features.h"

namespace strata::query {

// Parses the polygons of a GeoJSON text (RFC 7946: a FeatureCollection, a Feature or a geometry of
// Polygons and MultiPolygons), in their order, with the properties that are numbers, texts, or true
// and false (as 1 and 0). Features without a geometry, and further coordinates of a position, are
// skipped. Refused (malformed, `invalid` with the place in the text): text that is no GeoJSON,
// points and lines, rings of fewer than three points, more than kMaxMapPoints, kMaxMapFeatures or
// kMaxMapColumns.
Result<FeatureMap> parse_geojson(std::string_view text);

}  // namespace strata::query
