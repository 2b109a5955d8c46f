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

// The form of coordinates in GeoJSON.
struct CoordinateForm {
  int dimensions = 3;
  int decimals = 6;  // a micrometer if the coordinates are in meters
};
// Appends a feature as GeoJSON. `members` is inserted after its type, for example `"id":"3",`.
void append_feature(std::string& text, const app::FeatureTable& table, const app::Feature& feature,
                    const CoordinateForm& form, std::string_view members = {});

}  // namespace strata::net
