#pragma once

#include <bit>
#include <cmath>
#include <cstring>
#include <utility>
#include <vector>

#include "mesh/texels/surface_map.h"
#include "query/conditions/texel_selection.h"
#include "query/sampling/values.h"

namespace strata::query {

constexpr int kBlocksPerTile = kTileSize / kBlockSize;

// Sorts tiles by address. Sums of floats depend on their order, and the sums of a layer must be
// reproducible.
std::vector<std::pair<TileAddress, const TileData*>> sorted_tiles(const TileMap& tiles);

// Returns the 64 flags of a block of a mask; bit y * 8 + x is the texel (x, y).
inline std::uint64_t block_bits(const TileMask& mask, int block_x, int block_y) {
  std::uint64_t bits = 0;
  const int first = block_y * kBlockSize * kTileSize + block_x * kBlockSize;
  for (int row = 0; row < kBlockSize; ++row) {
    const int texel = first + row * kTileSize;
    bits |= (mask.words[static_cast<std::size_t>(texel >> 6)] >> (texel & 63) & 0xffu) << (8 * row);
  }
  return bits;
}

// Calls visit(slot, flags of the valid surface texels, first texel of the block in the tile) for
// each block of a tile with such texels. `within` restricts the texels; null means all texels.
template <class Visit>
void for_each_block_of(const TileData& tile, TileAddress address, const mesh::SurfaceMap& map,
                       const TexelSelection* within, Visit&& visit) {
  for (int by = 0; by < kBlocksPerTile; ++by) {
    const auto row =
        (static_cast<std::size_t>(address.y) * kBlocksPerTile + static_cast<std::size_t>(by)) *
        static_cast<std::size_t>(map.blocks_per_side);
    for (int bx = 0; bx < kBlocksPerTile; ++bx) {
      const std::uint32_t slot =
          map.slot_of_block[row + static_cast<std::size_t>(address.x) * kBlocksPerTile +
                            static_cast<std::size_t>(bx)];
      if (slot == mesh::kNoSlot) continue;
      std::uint64_t texels = map.surface_mask[slot] & block_bits(tile.valid, bx, by);
      if (within) texels &= (*within)[slot];
      if (texels != 0) visit(slot, texels, by * kBlockSize * kTileSize + bx * kBlockSize);
    }
  }
}

// Returns the bits of a texel of a block. `Bits` is the unsigned type that stores a texel.
template <class Bits>
Bits bits_in_block(const TileData& tile, int corner, int texel) {
  const int in_tile = corner + texel / kBlockSize * kTileSize + texel % kBlockSize;
  Bits bits;
  std::memcpy(&bits, tile.values.data() + static_cast<std::size_t>(in_tile) * sizeof(Bits),
              sizeof(Bits));
  return bits;
}

// Calls visit(slot, texel in the block, bits of the value) for each valid surface texel of a tile,
// block by block.
template <class Bits, class Visit>
void for_each_texel_of(const TileData& tile, TileAddress address, const mesh::SurfaceMap& map,
                       const TexelSelection* within, Visit&& visit) {
  for_each_block_of(tile, address, map, within,
                    [&](std::uint32_t slot, std::uint64_t texels, int corner) {
                      for (; texels != 0; texels &= texels - 1) {
                        const int texel = std::countr_zero(texels);
                        visit(slot, texel, bits_in_block<Bits>(tile, corner, texel));
                      }
                    });
}

// Returns the decoded values of all bit patterns of a type of one or two bytes, because half floats
// are slow to decode. Returns null for longer types.
const double* values_of_bits(ValueType type);

// Calls visit(slot, texel in the block, bits, value) for each texel that for_each_texel_of visits,
// if its value is finite. An imported raster may contain other values.
template <class Visit>
void for_each_value(const TileData& tile, TileAddress address, ValueType type,
                    const mesh::SurfaceMap& map, const TexelSelection* within, Visit&& visit) {
  const double* values = values_of_bits(type);
  const auto visit_short = [&](std::uint32_t slot, int texel, std::uint32_t bits) {
    if (const double value = values[bits]; std::isfinite(value)) visit(slot, texel, bits, value);
  };
  switch (bytes_per_texel(type)) {
    case 1: return for_each_texel_of<std::uint8_t>(tile, address, map, within, visit_short);
    case 2: return for_each_texel_of<std::uint16_t>(tile, address, map, within, visit_short);
    default:
      return for_each_texel_of<std::uint32_t>(
          tile, address, map, within, [&](std::uint32_t slot, int texel, std::uint32_t bits) {
            const double value = decode_value(type, bits);
            if (std::isfinite(value)) visit(slot, texel, bits, value);
          });
  }
}

}  // namespace strata::query
