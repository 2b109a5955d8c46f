#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "domain/layers/layer.h"
#include "domain/layers/tile_mirror.h"

namespace strata::query {

// Encode a layer as a raster file that also stores which texels are valid. Row 0 of the file is v =
// 1 (top). TIFF files are tiled and compressed with deflate. They have two samples per texel: the
// value in the type of the layer, and 1 (valid) or 0 in the same type. They also have an internal
// mask as in GDAL, because any integer may be painted. Floats that are not painted are NaN, which
// GDAL_NODATA declares. PNG files have gray and alpha, for u8 and u16 only; other types are a
// `not_acceptable` error. NPY files are NumPy structured arrays with the fields `value` and
// `valid`.
Result<std::vector<std::uint8_t>> encode_tiff(const Layer& layer, const TileMap& tiles);
Result<std::vector<std::uint8_t>> encode_png(const Layer& layer, const TileMap& tiles);
Result<std::vector<std::uint8_t>> encode_npy(const Layer& layer, const TileMap& tiles);

// Decode a raster file for import. The file must have the size of the layer. TIFF and NPY files
// have two samples per texel as above, or one. With one sample, NaN, GDAL's nodata and masked
// pixels are not painted. They may have any number type of 8 to 64 bits (NPY also bool), any byte
// order and any layout. A number that does not fit the type of the layer, except by rounding of
// floats, is an error with its row and column. PNG files must have the type of the layer.
Result<TileMap> decode_tiff(const Layer& layer, std::span<const std::uint8_t> bytes);
Result<TileMap> decode_png(const Layer& layer, std::span<const std::uint8_t> bytes);
Result<TileMap> decode_npy(const Layer& layer, std::span<const std::uint8_t> bytes);

}  // namespace strata::query
