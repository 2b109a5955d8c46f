#pragma once

#include <filesystem>

#include "net/feature_set.h"
#include "net/http/http_types.h"

namespace strata::net {

inline constexpr const char* kGeoPackageType = "application/geopackage+sqlite3";

// The tables as an OGC GeoPackage 1.3 (OGC 12-128r17), a table of features each, written by SQLite
// to a file in `folder`, which goes once it is sent. Geometries have a z. Without a known
// coordinate system they are in the undefined Cartesian one (-1). An area without extent has no
// geometry. 507 where the file could not be written.
Result<Response> geopackage(const FeatureSet& set, const std::filesystem::path& folder);

}  // namespace strata::net
