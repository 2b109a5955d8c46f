#include "query/maps/point_splats.h"

#include <array>
#include <bit>
#include <limits>
#include <unordered_map>
#include <unordered_set>

#include "mesh/texels/gutter_ring.h"
#include "mesh/texels/slot_bits.h"

namespace strata::query {
namespace {

constexpr int kTexels = kBlockSize * kBlockSize;

// The nearest splat of each texel of a block.
struct Nearest {
  std::array<float, kTexels> distance;
  std::array<std::uint32_t, kTexels> bits{};
  std::uint64_t reached = 0;
  Nearest() { distance.fill(std::numeric_limits<float>::infinity()); }
};
using NearestOfSlot = std::unordered_map<std::uint32_t, Nearest>;

glm::ivec2 corner_of(const mesh::SurfaceMap& map, std::uint32_t slot) {
  const auto block = static_cast<int>(map.block_of_slot[slot]);
  return {block % map.blocks_per_side * kBlockSize, block / map.blocks_per_side * kBlockSize};
}

void write(std::map<TileAddress, TileData>& tiles, ValueType type, int x, int y,
           std::uint32_t bits) {
  const TileAddress address{static_cast<std::uint16_t>(x / kTileSize),
                            static_cast<std::uint16_t>(y / kTileSize)};
  tiles.try_emplace(address, type)
      .first->second.write(y % kTileSize * kTileSize + x % kTileSize, bits);
}

// Writes to each gutter texel of the slot the value of its surface texel.
void write_gutter(const mesh::SurfaceMap& map, const NearestOfSlot& nearest, std::uint32_t slot,
                  ValueType type, std::map<TileAddress, TileData>& tiles) {
  const glm::ivec2 corner = corner_of(map, slot);
  for (std::uint64_t rest = ~map.surface_mask[slot]; rest != 0; rest &= rest - 1) {
    const int i = std::countr_zero(rest), x = corner.x + i % kBlockSize,
              y = corner.y + i / kBlockSize;
    if (map.packed_position[std::size_t{slot} * kTexels + i] == mesh::kNoPosition) continue;
    for (const mesh::TexelOffset o : mesh::kGutterRingOffsets) {
      const int ox = x + o.x, oy = y + o.y;
      if (ox < 0 || oy < 0) continue;
      const auto owner_slot = mesh::slot_at(map, ox / kBlockSize, oy / kBlockSize);
      const int owner = oy % kBlockSize * kBlockSize + ox % kBlockSize;
      if (owner_slot == mesh::kNoSlot || !((map.surface_mask[owner_slot] >> owner) & 1u)) continue;
      const auto found = nearest.find(owner_slot);
      if (found != nearest.end() && ((found->second.reached >> owner) & 1u))
        write(tiles, type, x, y, found->second.bits[owner]);
      break;
    }
  }
}

}  // namespace

Result<std::map<TileAddress, TileData>> paint_point_splats(const mesh::SurfaceMap& map,
                                                           const mesh::TexelGraph& graph,
                                                           std::span<const PointSplat> point_splats,
                                                           float radius, ValueType type) {
  NearestOfSlot nearest;
  std::uint64_t reached_in_all = 0;
  std::unordered_set<std::uint32_t> seen;
  std::vector<std::uint32_t> open;
  for (const PointSplat& splat : point_splats) {
    seen.clear();
    // The texel at the position itself is always reached, so that a splat smaller than a texel is
    // not lost.
    const auto reach = [&](std::uint32_t texel, bool always) {
      const std::uint32_t slot = texel / kTexels, i = texel % kTexels;
      const float distance = glm::distance(map.position(slot, static_cast<int>(i)), splat.position);
      if ((distance > radius && !always) || !seen.insert(texel).second) return;
      open.push_back(texel);
      Nearest& block = nearest[slot];
      block.reached |= std::uint64_t{1} << i;
      if (distance >= block.distance[i]) return;
      block.distance[i] = distance;
      block.bits[i] = splat.bits;
    };
    reach(splat.texel, true);
    while (!open.empty()) {
      const std::uint32_t texel = open.back();
      open.pop_back();
      mesh::for_each_neighbour(map, graph, texel, [&](std::uint32_t next) { reach(next, false); });
    }
    reached_in_all += seen.size();
    if (reached_in_all > kMaxDabTexels)
      return fail(ErrorCode::invalid, "Painted area too large",
                  "With this radius, the points cover too large an area. Choose a smaller radius.",
                  "radius_mm");
  }

  std::map<TileAddress, TileData> tiles;
  std::unordered_set<std::uint32_t> with_gutter;
  for (const auto& [slot, block] : nearest) {
    const glm::ivec2 corner = corner_of(map, slot);
    for (std::uint64_t rest = block.reached; rest != 0; rest &= rest - 1) {
      const int i = std::countr_zero(rest);
      write(tiles, type, corner.x + i % kBlockSize, corner.y + i / kBlockSize, block.bits[i]);
    }
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx)
        if (const auto near =
                mesh::slot_at(map, corner.x / kBlockSize + dx, corner.y / kBlockSize + dy);
            near != mesh::kNoSlot)
          with_gutter.insert(near);
  }
  for (const std::uint32_t slot : with_gutter) write_gutter(map, nearest, slot, type, tiles);
  return tiles;
}

}  // namespace strata::query
