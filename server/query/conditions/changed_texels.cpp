#include "query/conditions/changed_texels.h"

#include <algorithm>
#include <memory>
#include <vector>

#include "domain/layers/tile_difference.h"
#include "domain/people/question.h"
#include "mesh/parallel.h"
#include "query/conditions/texel_values.h"
#include "query/conditions/tile_table.h"

namespace strata::query {
namespace {

// The texels that differ in each tile of a layer; null if no texel of the tile differs.
class ChangedTiles {
 public:
  ChangedTiles(const Layer& layer, const TileMap& from, const TileMap& to)
      : tiles_per_side_(layer.resolution / kTileSize),
        masks_(static_cast<std::size_t>(tiles_per_side_) *
               static_cast<std::size_t>(tiles_per_side_)) {
    const TileData empty(layer.type);
    const auto content = [&](const TileMap& tiles, TileAddress address) -> const TileData* {
      const auto found = tiles.find(address);
      return found == tiles.end() || !found->second ? &empty : found->second.get();
    };
    const auto compare = [&](TileAddress address) {
      if (address.x >= tiles_per_side_ || address.y >= tiles_per_side_) return;
      const TileData *before = content(from, address), *after = content(to, address);
      if (before == after) return;
      check_question();
      const TileMask mask = differing(*before, *after);
      if (mask.any()) masks_[place(address.x, address.y)] = std::make_unique<TileMask>(mask);
    };
    for (const auto& [address, tile] : from) compare(address);
    for (const auto& [address, tile] : to)
      if (!from.contains(address)) compare(address);
  }

  const TileMask* of_texel(int x, int y) const {
    return masks_[place(x / kTileSize, y / kTileSize)].get();
  }

 private:
  std::size_t place(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(tiles_per_side_) +
           static_cast<std::size_t>(x);
  }

  int tiles_per_side_;
  std::vector<std::unique_ptr<TileMask>> masks_;
};

std::uint64_t bytes_without(const TileMap& tiles, const TileMap& others) {
  std::uint64_t bytes = 0;
  for (const auto& [address, tile] : tiles) {
    const auto other = others.find(address);
    if (tile && (other == others.end() || other->second != tile)) bytes += tile->values.size();
  }
  return bytes;
}

}  // namespace

std::uint64_t bytes_apart(const TileMap& from, const TileMap& to) {
  return bytes_without(from, to) + bytes_without(to, from);
}

void add_changed_texels(const Layer& layer, const TileMap& from, const TileMap& to,
                        const mesh::SurfaceMap& map, int threads, TexelSelection& selection) {
  const ChangedTiles changed(layer, from, to);
  const TileTable lattice({}, layer.resolution);
  const bool is_same = layer.resolution == map.resolution;
  const auto in_block = [&](int bx, int by) -> std::uint64_t {
    if (is_same) {
      const TileMask* mask = changed.of_texel(bx * kBlockSize, by * kBlockSize);
      return mask ? block_bits(*mask, bx % kBlocksPerTile, by % kBlocksPerTile) : 0;
    }
    std::uint64_t bits = 0;
    for (int i = 0; i < kBlockSize * kBlockSize; ++i) {
      const int x = lattice.texel_under(bx * kBlockSize + i % kBlockSize, map.resolution),
                y = lattice.texel_under(by * kBlockSize + i / kBlockSize, map.resolution);
      const TileMask* mask = changed.of_texel(x, y);
      if (mask && mask->test(y % kTileSize * kTileSize + x % kTileSize))
        bits |= std::uint64_t{1} << i;
    }
    return bits;
  };
  constexpr std::size_t kSlotsAtOnce = 4096;
  const std::size_t slots = map.block_of_slot.size();
  mesh::parallel_for(
      threads, static_cast<int>((slots + kSlotsAtOnce - 1) / kSlotsAtOnce), [&](int part) {
        const std::size_t first = static_cast<std::size_t>(part) * kSlotsAtOnce;
        for (std::size_t slot = first; slot < std::min(slots, first + kSlotsAtOnce); ++slot) {
          if (map.surface_mask[slot] == 0) continue;
          const int block = static_cast<int>(map.block_of_slot[slot]);
          selection[slot] |= map.surface_mask[slot] &
                             in_block(block % map.blocks_per_side, block / map.blocks_per_side);
        }
      });
}

}  // namespace strata::query
