#pragma once

#include <tiffio.h>

#include <glm/glm.hpp>
#include <string>

#include "query/maps/map_tiff.h"

namespace strata::query {

// Reads the position, coordinate system and nodata of an open TIFF into `info`. Supports GeoTIFF
// 1.1 (OGC 19-008: ModelPixelScale with one ModelTiepoint, or ModelTransformation, and
// GeoKeyDirectory with inline keys) and GDAL_NODATA. Skips tags of another type. Uses only libtiff,
// because libgeotiff would add little to read and write a few numbers. Returns an
// `invalid` error for pixels without area.
Result<void> read_geo_tags(TIFF* tiff, MapTiff& info);

// Returns GDAL's nodata of an open TIFF. Returns nothing if it is missing, or NaN, because NaN is
// never a value.
std::optional<double> nodata_of(TIFF* tiff);
void set_nodata(TIFF* tiff, const char* number);

// Sets the position and the coordinate system of a north-up raster, in meters. `epsg` is a
// projected system. If it is 0, the file names a local plane instead, which GDAL reads as a local
// system.
void set_geo_tags(TIFF* tiff, const glm::dvec2& top_left, const glm::dvec2& cell, int epsg,
                  const std::string& plane);
// Sets GDAL's XML, such as the name and the unit of a band.
void set_gdal_metadata(TIFF* tiff, const std::string& xml);

}  // namespace strata::query
