#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "query/maps/plane_raster.h"

namespace strata::query {

// The position of a raster in its coordinate system, in meters, and the meaning of its values.
struct GeoReference {
  glm::dvec2 top_left{0};  // outer corner of the first cell: easting and northing
  glm::dvec2 cell{1};      // size of a cell, both positive
  int epsg = 0;            // projected system; 0 for a local plane
  std::string plane;       // name of the local plane: "Wall: x and z"
  std::string name, unit;  // of the values
};

// Encodes a raster as GeoTIFF 1.1 (OGC 19-008) with one band, tiled and compressed with deflate.
// Empty cells have the number that GDAL_NODATA declares. It is NaN for floats. For integers it is a
// number that no cell has; if all numbers of an 8- or 16-bit type occur, the band gets the next
// wider type. Half floats become floats, because few programs read them. Returns a `conflict` error
// if a 32-bit raster has no free number, which requires 2³² cells.
Result<std::vector<std::uint8_t>> encode_geotiff(const PlaneRaster& raster,
                                                 const GeoReference& reference);

}  // namespace strata::query
