#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/layer.h"
#include "core/tile_mirror.h"

namespace strata::query {

// A layer as a picture file, with its valid plane. Row 0 of the file is v = 1 (top).
// tif: tiled, deflate, two samples (value in the layer's type, then valid as 1/0 in the same type), GDAL-style nodata
// is not used because every value may be valid. png: u8 and u16 only, grey + alpha (otherwise a Problem 406).
// npy: NumPy structured array, fields `value` and `valid`.
Result<std::vector<std::uint8_t>> encode_tiff(const Layer& layer, const TileMap& tiles);
Result<std::vector<std::uint8_t>> encode_png(const Layer& layer, const TileMap& tiles);
Result<std::vector<std::uint8_t>> encode_npy(const Layer& layer, const TileMap& tiles);

// The reverse, for import: same size and type as the layer, else a Problem that says what was found and what is needed.
Result<TileMap> decode_tiff(const Layer& layer, std::span<const std::uint8_t> bytes);
Result<TileMap> decode_png(const Layer& layer, std::span<const std::uint8_t> bytes);
Result<TileMap> decode_npy(const Layer& layer, std::span<const std::uint8_t> bytes);

}  // namespace strata::query
