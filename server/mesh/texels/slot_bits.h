#pragma once

#include <bit>
#include <cstdint>
#include <span>

#include "domain/layers/tile.h"
#include "mesh/texels/gutter_ring.h"
#include "mesh/texels/surface_map.h"

namespace strata::mesh {

// Conversions between the slots of a surface map, with one bit for each of their 64 texels, and the
// tiles of the layers.

// Returns the slot of a block, or kNoSlot if the block is empty or outside the map.
inline std::uint32_t slot_at(const SurfaceMap& map, int block_x, int block_y) {
  if (block_x < 0 || block_y < 0 || block_x >= map.blocks_per_side ||
      block_y >= map.blocks_per_side)
    return kNoSlot;
  return map.slot_of_block[static_cast<std::size_t>(block_y) * map.blocks_per_side + block_x];
}

// The position of a tile's texel in the map. The slot may be kNoSlot.
struct SlotTexel {
  std::uint32_t slot;
  int texel;  // y * 8 + x
};
SlotTexel slot_texel(const SurfaceMap& map, TileAddress tile, int texel);

// Calls bits_of(slot) for each occupied block of the tile and stores its 64 bits.
template <class BitsOf>
TileMask gather_tile_bits(const SurfaceMap& map, TileAddress tile, BitsOf&& bits_of) {
  constexpr int kBlocksPerTileSide = kTileSize / kBlockSize;
  TileMask mask;
  for (int by = 0; by < kBlocksPerTileSide; ++by)
    for (int bx = 0; bx < kBlocksPerTileSide; ++bx) {
      const auto slot =
          slot_at(map, tile.x * kBlocksPerTileSide + bx, tile.y * kBlocksPerTileSide + by);
      if (slot == kNoSlot) continue;
      const std::uint64_t bits = bits_of(slot);
      for (int row = 0; row < kBlockSize; ++row) {
        const int first = (by * kBlockSize + row) * kTileSize + bx * kBlockSize;
        mask.words[first >> 6] |= ((bits >> (8 * row)) & 0xff) << (first & 63);
      }
    }
  return mask;
}

// Calls visit(gutter, owner) for every gutter texel and the surface texel that it follows.
template <class Visit>
void for_each_gutter_texel(const SurfaceMap& map, Visit&& visit) {
  for (std::uint32_t slot = 0; slot < map.block_of_slot.size(); ++slot) {
    const auto block = static_cast<int>(map.block_of_slot[slot]);
    const int first_x = block % map.blocks_per_side * kBlockSize,
              first_y = block / map.blocks_per_side * kBlockSize;
    for (std::uint64_t rest = ~map.surface_mask[slot]; rest != 0; rest &= rest - 1) {
      const int texel = std::countr_zero(rest), x = first_x + texel % kBlockSize,
                y = first_y + texel / kBlockSize;
      if (map.packed_position[std::size_t{slot} * 64 + static_cast<std::size_t>(texel)] ==
          kNoPosition)
        continue;
      for (const TexelOffset o : kGutterRingOffsets) {
        const int at_x = x + o.x, at_y = y + o.y;
        if (at_x < 0 || at_y < 0) continue;
        const SlotTexel owner{slot_at(map, at_x / kBlockSize, at_y / kBlockSize),
                              at_y % kBlockSize * kBlockSize + at_x % kBlockSize};
        if (owner.slot == kNoSlot || ((map.surface_mask[owner.slot] >> owner.texel) & 1u) == 0)
          continue;
        visit(SlotTexel{slot, texel}, owner);
        break;
      }
    }
  }
}

// `bits_of_slot` has one word per slot and one bit per surface texel. Sets the bit of each gutter
// texel to the bit of the surface texel that it follows.
void spread_to_gutter(const SurfaceMap& map, std::span<std::uint64_t> bits_of_slot);

}  // namespace strata::mesh
