#pragma once

#include "app/layers/feature_set.h"
#include "net/http/http_types.h"

namespace strata::net {

inline constexpr const char* kGeoJsonType = "application/geo+json";

// Returns all tables as one FeatureCollection (RFC 7946) that is created while it is sent. Unlike
// in the RFC, the coordinates are in the model's coordinate system. If this system is known, it is
// in the `crs` member of GeoJSON 2008, which GDAL and QGIS read. An area without extent has a null
// geometry.
Response feature_json(app::FeatureSet set);

}  // namespace strata::net
