#pragma once

#include "app/layers/feature_set.h"
#include "net/http/http_types.h"

namespace strata::net {

inline constexpr const char* kGeoJsonType = "application/geo+json";

// All tables as one FeatureCollection (RFC 7946, but for coordinates, which are the model's), made
// while it is sent. Where the coordinate system is known there is the `crs` member of GeoJSON 2008,
// which GDAL and QGIS read. An area without extent has a null geometry.
Response feature_json(app::FeatureSet set);

}  // namespace strata::net
