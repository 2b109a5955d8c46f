#pragma once

#include <filesystem>
#include <memory>

#include "app/layers/feature_set.h"
#include "core/error.h"
#include "core/temporary_file.h"

namespace strata::app {

inline constexpr const char* kGeoPackageType = "application/geopackage+sqlite3";

// Writes the tables as an OGC GeoPackage 1.3 (OGC 12-128r17) with SQLite to a file in `folder`, one
// table of features each. Geometries have z. Without a known coordinate system they are in the
// undefined Cartesian one (-1). An area without extent has no geometry. Refused (storage_full): the
// file could not be written.
Result<std::shared_ptr<const TemporaryFile>> geopackage(const FeatureSet& set,
                                                        const std::filesystem::path& folder);

}  // namespace strata::app
