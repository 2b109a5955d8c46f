#pragma once

#include <filesystem>
#include <memory>

#include "app/layers/feature_set.h"
#include "core/error.h"
#include "core/temporary_file.h"

namespace strata::app {

inline constexpr const char* kGeoPackageType = "application/geopackage+sqlite3";

// Writes the tables as an OGC GeoPackage 1.3 (OGC 12-128r17) to a file in `folder`, with SQLite.
// Each table becomes one feature table. All geometries have z coordinates. If the coordinate system
// is unknown, they use the undefined Cartesian system (-1). An area without extent has no geometry.
// Returns storage_full if the file could not be written.
Result<std::shared_ptr<const TemporaryFile>> geopackage(const FeatureSet& set,
                                                        const std::filesystem::path& folder);

}  // namespace strata::app
