#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "domain/layers/layer.h"
#include "domain/layers/tile_mirror.h"

namespace strata::query {

// A layer as a raster file, with its valid plane. Row 0 of the file is v = 1 (top). tif: tiled,
// deflate, two samples (value in the layer's type, then valid as 1/0 in the same type), and an
// internal mask as in GDAL, because any integer may be painted; floats that are not painted are
// NaN, declared by GDAL_NODATA. png: u8 and u16 only, gray + alpha (otherwise an Error
// `not_acceptable`). npy: NumPy structured array, fields `value` and `valid`.
Result<std::vector<std::uint8_t>> encode_tiff(const Layer& layer, const TileMap& tiles);
Result<std::vector<std::uint8_t>> encode_png(const Layer& layer, const TileMap& tiles);
Result<std::vector<std::uint8_t>> encode_npy(const Layer& layer, const TileMap& tiles);

// The reverse, for import: with the size of the layer. tif and npy: one sample (NaN, GDAL's nodata
// and masked pixels are not painted), or two as above, of any number type of 8 to 64 bits (npy also
// bool), byte order and layout. A number that does not fit into the layer's type, except by
// rounding of floats, is an Error with its row and column. png: of the layer's type.
Result<TileMap> decode_tiff(const Layer& layer, std::span<const std::uint8_t> bytes);
Result<TileMap> decode_png(const Layer& layer, std::span<const std::uint8_t> bytes);
Result<TileMap> decode_npy(const Layer& layer, std::span<const std::uint8_t> bytes);

}  // namespace strata::query
