#include "mesh/slot_bits.h"

#include <bit>

#include "mesh/gutter_ring.h"

namespace strata::mesh {

SlotTexel slot_texel(const SurfaceMap& map, TileAddress tile, int texel) {
  const int x = tile.x * kTileSize + texel % kTileSize, y = tile.y * kTileSize + texel / kTileSize;
  return {slot_at(map, x / kBlockSize, y / kBlockSize), y % kBlockSize * kBlockSize + x % kBlockSize};
}

void spread_to_gutter(const SurfaceMap& map, std::span<std::uint64_t> bits_of_slot) {
  const auto test = [&](std::span<const std::uint64_t> words, int x, int y) {
    if (x < 0 || y < 0) return false;
    const auto slot = slot_at(map, x / kBlockSize, y / kBlockSize);
    return slot != kNoSlot && ((words[slot] >> (y % kBlockSize * kBlockSize + x % kBlockSize)) & 1u) != 0;
  };
  for (std::uint32_t slot = 0; slot < map.block_of_slot.size(); ++slot) {
    std::uint64_t followers = 0;
    const auto block = static_cast<int>(map.block_of_slot[slot]);
    const int first_x = block % map.blocks_per_side * kBlockSize, first_y = block / map.blocks_per_side * kBlockSize;
    for (std::uint64_t rest = ~map.surface_mask[slot]; rest != 0; rest &= rest - 1) {
      const int i = std::countr_zero(rest), x = first_x + i % kBlockSize, y = first_y + i / kBlockSize;
      if (map.packed_position[std::size_t{slot} * 64 + i] == kNoPosition) continue;
      for (const TexelOffset o : kGutterRingOffsets) {
        if (!test(map.surface_mask, x + o.x, y + o.y)) continue;
        followers |= std::uint64_t{test(bits_of_slot, x + o.x, y + o.y)} << i;
        break;
      }
    }
    bits_of_slot[slot] = (bits_of_slot[slot] & map.surface_mask[slot]) | followers;
  }
}

}  // namespace strata::mesh
