#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "domain/layers/value_type.h"
#include "media/picture.h"
#include "query/rasters/world_file.h"

namespace strata::query {

// Reads TIFF and GeoTIFF files as maps: orthophotos and rasters of numbers. Thread-safe.

bool is_tiff(std::span<const std::uint8_t> bytes);  // checks the first bytes; true for BigTIFF, too

struct MapTiff {
  int width = 0, height = 0, bands = 0;
  ValueType type = ValueType::u8;  // type of the samples; f64 is read as f32
  // true if decode_tiff_band can read the file: lossless samples of 8, 16 or 32 bits (or f64)
  bool has_numbers = false;
  // true if decode_tiff_picture can read the file: gray, a color table or RGB of up to 16 bits
  bool has_colors = false;
  bool is_rgb = false;             // true if its bands are colors
  std::optional<WorldFile> world;  // position from the GeoTIFF tags
  std::optional<double> nodata;    // value of GDAL's tag
  std::string crs;                 // such as "EPSG:25830"; empty if not given
  bool in_degrees = false;
};

// Reads the header only. Returns an `invalid` error for a file that is not a TIFF or is damaged,
// and for a side of more than `largest_side` pixels. Contradictory tags, and a file with neither
// readable numbers nor readable colors, are `invalid`, too.
Result<MapTiff> inspect_tiff(std::span<const std::uint8_t> bytes, int largest_side);

// Row 0 is at the top. Pixels with the nodata number in every band are transparent.
Result<Picture> decode_tiff_picture(std::span<const std::uint8_t> bytes, const MapTiff& info);

// The numbers of one band; row 0 is at the top.
struct BandRaster {
  int width = 0, height = 0;
  ValueType type = ValueType::u8;
  std::vector<std::uint32_t> bits;  // bits of the values, which have type `type`
  std::vector<std::uint8_t> valid;  // 0 for nodata and for numbers that are not finite
};
// Decodes one band; the first band is 1. Returns an `invalid` error if the band does not exist or
// the file ends too early.
Result<BandRaster> decode_tiff_band(std::span<const std::uint8_t> bytes, const MapTiff& info,
                                    int band);

}  // namespace strata::query
