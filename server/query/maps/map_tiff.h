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

bool is_tiff(std::span<const std::uint8_t> bytes);  // also BigTIFF; by the first bytes

struct MapTiff {
  int width = 0, height = 0, bands = 0;
  ValueType type = ValueType::u8;  // of the samples; 64-bit floating-point numbers are read as f32
  // decode_tiff_band can read it: samples of 8, 16 or 32 bits (or f64) without loss
  bool has_numbers = false;
  // decode_tiff_picture can read it: gray, a color table or RGB of up to 16 bits
  bool has_colors = false;
  bool is_rgb = false;             // its bands are colors
  std::optional<WorldFile> world;  // from its GeoTIFF tags
  std::optional<double> nodata;    // GDAL's tag
  std::string crs;                 // "EPSG:25830"; empty: not given
  bool in_degrees = false;
};

// Reads the header only. Refused (invalid): no TIFF, damaged, a side of more than `largest_side`,
// tags that contradict each other, neither numbers nor colors that can be read.
Result<MapTiff> inspect_tiff(std::span<const std::uint8_t> bytes, int largest_side);

// Row 0 is at the top. Pixels with the nodata number in every band are transparent.
Result<Picture> decode_tiff_picture(std::span<const std::uint8_t> bytes, const MapTiff& info);

// The numbers of one band; row 0 is at the top.
struct BandRaster {
  int width = 0, height = 0;
  ValueType type = ValueType::u8;
  std::vector<std::uint32_t> bits;  // of `type`
  std::vector<std::uint8_t> valid;  // 0: nodata, or not a finite number
};
// `band` counts from 1. Refused (invalid): no such band; the file ends too early.
Result<BandRaster> decode_tiff_band(std::span<const std::uint8_t> bytes, const MapTiff& info,
                                    int band);

}  // namespace strata::query
