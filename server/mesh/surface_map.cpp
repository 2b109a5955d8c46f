#include "mesh/surface_map.h"

#include "mesh/packed_position.h"

namespace strata::mesh {
namespace {

constexpr int kBlocksPerTileSide = kTileSize / kBlockSize;

std::uint32_t slot_at(const SurfaceMap& map, int block_x, int block_y) {
  if (block_x >= map.blocks_per_side || block_y >= map.blocks_per_side) return kNoSlot;
  return map.slot_of_block[static_cast<std::size_t>(block_y) * map.blocks_per_side + block_x];
}

// Calls bits_of(slot) for each occupied block of the tile and puts its 64 bits in place.
template <class BitsOf>
TileMask gather(const SurfaceMap& map, TileAddress tile, BitsOf&& bits_of) {
  TileMask mask;
  for (int by = 0; by < kBlocksPerTileSide; ++by)
    for (int bx = 0; bx < kBlocksPerTileSide; ++bx) {
      const auto slot = slot_at(map, tile.x * kBlocksPerTileSide + bx, tile.y * kBlocksPerTileSide + by);
      if (slot == kNoSlot) continue;
      const std::uint64_t bits = bits_of(slot);
      for (int row = 0; row < kBlockSize; ++row) {
        const int first = (by * kBlockSize + row) * kTileSize + bx * kBlockSize;
        mask.words[first >> 6] |= ((bits >> (8 * row)) & 0xff) << (first & 63);
      }
    }
  return mask;
}

}  // namespace

glm::vec3 SurfaceMap::position(std::uint32_t slot, int texel) const {
  return unpack_position(packed_position[std::size_t{slot} * 64 + texel], packed_box[slot]);
}

TileMask SurfaceMap::owned_in_tile(TileAddress tile) const {
  return gather(*this, tile, [&](std::uint32_t slot) {
    std::uint64_t bits = 0;
    for (int i = 0; i < 64; ++i) bits |= std::uint64_t{packed_position[std::size_t{slot} * 64 + i] != kNoPosition} << i;
    return bits;
  });
}

TileMask SurfaceMap::surface_in_tile(TileAddress tile) const {
  return gather(*this, tile, [&](std::uint32_t slot) { return surface_mask[slot]; });
}

float SurfaceMap::area_of(TileAddress tile, int texel) const {
  const int x = texel % kTileSize, y = texel / kTileSize;
  const auto slot =
      slot_at(*this, tile.x * kBlocksPerTileSide + x / kBlockSize, tile.y * kBlocksPerTileSide + y / kBlockSize);
  if (slot == kNoSlot) return 0;
  return area[std::size_t{slot} * 64 + (y % kBlockSize) * kBlockSize + x % kBlockSize];
}

std::size_t SurfaceMap::bytes() const {
  const auto of = [](const auto& v) { return v.capacity() * sizeof(v[0]); };
  return of(slot_of_block) + of(block_of_slot) + of(packed_position) + of(packed_box) + of(surface_mask) + of(area) +
         of(bounds_8) + of(bounds_32) + of(bounds_128);
}

}  // namespace strata::mesh
