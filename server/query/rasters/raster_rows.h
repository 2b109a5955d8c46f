#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "domain/layers/layer.h"
#include "domain/layers/tile_mirror.h"

namespace strata::query {

// Reads the texels of a layer row by row, in the row order of a raster file. Row 0 is at the top
// (v = 1), while tiles are numbered from the bottom.
class TileRows {
 public:
  TileRows(const Layer& layer, const TileMap& tiles);  // keeps a reference to `tiles`
  // Both spans have `resolution` entries. For invalid texels, `bits` contains 0.
  void read(int file_row, std::span<std::uint32_t> bits, std::span<std::uint8_t> valid) const;

 private:
  int resolution_;
  int tiles_per_side_;
  std::vector<const TileData*> tiles_;
};

// Builds tiles from texels in any order. Tiles without a valid texel are left out.
class TileMapBuilder {
 public:
  explicit TileMapBuilder(const Layer& layer);
  // Sets a valid texel from its little-endian bytes. A float that is not finite is an error with
  // its position.
  Result<void> put(int x, int file_row, const std::uint8_t* value);
  TileMap finish();

 private:
  ValueType type_;
  int bytes_;
  int resolution_;
  int tiles_per_side_;
  std::vector<std::shared_ptr<TileData>> tiles_;
};

// Returns the common error for rasters: `invalid`, "Raster not accepted".
tl::unexpected<Error> refuse_raster(std::string detail);
// Describes the raster that the layer needs, such as "2048 × 2048 texels of u16".
std::string raster_needs(const Layer& layer);
// Refuses a width or height that differs from the layer's.
Result<void> check_raster_size(const Layer& layer, std::uint64_t width, std::uint64_t height);

}  // namespace strata::query
