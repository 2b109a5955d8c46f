#pragma once

#include <tiffio.h>

#include "query/map_tiff.h"

namespace strata::query {

// Place, coordinate system and nodata of an open TIFF into `info`: GeoTIFF 1.1 (OGC 19-008, ModelPixelScale with one ModelTiepoint
// or ModelTransformation, GeoKeyDirectory with keys in itself) and GDAL_NODATA. Tags of another type are passed over. libtiff alone
// does: libgeotiff would bring PROJ and its 23 MB of data for two numbers. Refused (422): pixels without area.
Result<void> read_geo_tags(TIFF* tiff, MapTiff& info);

}  // namespace strata::query
