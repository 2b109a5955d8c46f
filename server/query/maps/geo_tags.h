#pragma once

#include <tiffio.h>

#include "query/maps/map_tiff.h"

namespace strata::query {

// Reads the position, coordinate system and nodata of an open TIFF into `info`. Supports GeoTIFF
// 1.1 (OGC 19-008: ModelPixelScale with one ModelTiepoint, or ModelTransformation, and
// GeoKeyDirectory with inline keys) and GDAL_NODATA. Skips tags of another type. Uses only libtiff,
// because libgeotiff would require PROJ with 23 MB of data to read two numbers. Returns an
// `invalid` error for pixels without area.
Result<void> read_geo_tags(TIFF* tiff, MapTiff& info);

// Returns GDAL's nodata of an open TIFF. Returns nothing if it is missing, or NaN, because NaN is
// never a value.
std::optional<double> nodata_of(TIFF* tiff);
void set_nodata(TIFF* tiff, const char* number);

}  // namespace strata::query
