#include "mesh/texels/slot_bits.h"

namespace strata::mesh {

SlotTexel slot_texel(const SurfaceMap& map, TileAddress tile, int texel) {
  const int x = tile.x * kTileSize + texel % kTileSize, y = tile.y * kTileSize + texel / kTileSize;
  return {slot_at(map, x / kBlockSize, y / kBlockSize),
          y % kBlockSize * kBlockSize + x % kBlockSize};
}

void spread_to_gutter(const SurfaceMap& map, std::span<std::uint64_t> bits_of_slot) {
  for (std::uint32_t slot = 0; slot < map.block_of_slot.size(); ++slot)
    bits_of_slot[slot] &= map.surface_mask[slot];
  for_each_gutter_texel(map, [&](SlotTexel gutter, SlotTexel owner) {
    bits_of_slot[gutter.slot] |= ((bits_of_slot[owner.slot] >> owner.texel) & 1u) << gutter.texel;
  });
}

}  // namespace strata::mesh
