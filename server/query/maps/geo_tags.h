#pragma once

#include <tiffio.h>

#include "query/maps/map_tiff.h"

namespace strata::query {

// Reads position, coordinate system and nodata of an open TIFF into `info`: GeoTIFF 1.1 (OGC
// 19-008, ModelPixelScale with one ModelTiepoint or ModelTransformation, GeoKeyDirectory with
// inline keys) and GDAL_NODATA. Tags of another type are skipped. Uses libtiff only: libgeotiff
// would require PROJ and its 23 MB of data for two numbers. Refused (invalid): pixels without area.
Result<void> read_geo_tags(TIFF* tiff, MapTiff& info);

// GDAL's nodata of an open TIFF; nothing if it is missing or NaN, which is never a value.
std::optional<double> nodata_of(TIFF* tiff);
void set_nodata(TIFF* tiff, const char* number);

}  // namespace strata::query
