#pragma once

#include <vector>

#include "domain/layers/tile_mirror.h"

namespace strata::query {

// The tiles of a layer as a dense table, with one lookup per block or texel. Does not own the
// tiles.
class TileTable {
 public:
  TileTable(const TileMap& tiles, int resolution) : tiles_per_side_(resolution / kTileSize) {
    tiles_.resize(std::size_t(tiles_per_side_) * tiles_per_side_);
    for (const auto& [address, tile] : tiles)
      if (address.x < tiles_per_side_ && address.y < tiles_per_side_)
        tiles_[std::size_t(address.y) * tiles_per_side_ + address.x] = tile.get();
  }

  // Returns null if the tile has no valid texel.
  const TileData* of_texel(int x, int y) const {
    return tiles_[std::size_t(y / kTileSize) * tiles_per_side_ + x / kTileSize];
  }
  // Returns, along one axis, the texel of the layer that contains the center of a texel of a map
  // with another resolution.
  int texel_under(int texel, int map_resolution) const {
    return static_cast<int>((2 * std::int64_t{texel} + 1) *
                            (std::int64_t{tiles_per_side_} * kTileSize) /
                            (2 * std::int64_t{map_resolution}));
  }
  const TileData* of_block(int bx, int by) const {
    return of_texel(bx * kBlockSize, by * kBlockSize);
  }

 private:
  int tiles_per_side_;
  std::vector<const TileData*> tiles_;
};

}  // namespace strata::query
