#include "room/pipeline/tile_changes.h"

#include <bit>
#include <set>

#include "domain/layers/mask_texels.h"
#include "domain/layers/tile_difference.h"
#include "mesh/texels/slot_bits.h"
#include "query/conditions/texel_values.h"
#include "query/statistics/surface_keys.h"

namespace strata::room {
namespace {

// Writes `value` to the texels of `mask_of(address)` in each tile.
template <class MaskOf>
std::vector<TileChange> fill(const TileMap& tiles, ValueType type, const mesh::SurfaceMap& map,
                             WrittenValue value, MaskOf mask_of) {
  std::vector<TileChange> changes;
  const int tiles_per_side = map.resolution / kTileSize;
  for (int y = 0; y < tiles_per_side; ++y)
    for (int x = 0; x < tiles_per_side; ++x) {
      const TileAddress address{static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y)};
      const TileMask mask = mask_of(address);
      if (!mask.any()) continue;
      auto before = tile_or_empty(tiles, address, type);
      if (!value && !before->valid.any()) continue;
      auto after = std::make_shared<TileData>(*before);
      for_each_texel(mask,
                     [&](int texel) { value ? after->write(texel, *value) : after->clear(texel); });
      changes.push_back({address, std::move(before), std::move(after), mask});
    }
  return changes;
}

}  // namespace

std::shared_ptr<const TileData> tile_or_empty(const TileMap& tiles, TileAddress address,
                                              ValueType type) {
  auto found = tiles.find(address);
  if (found != tiles.end() && found->second) return found->second;
  return std::make_shared<const TileData>(type);
}

ChangeCount count_changes(const TileChange& change, const mesh::SurfaceMap& map) {
  ChangeCount count;
  const TileMask changed = differing(*change.before, *change.after);
  if (!changed.any()) return count;
  constexpr int kBlocks = query::kBlocksPerTile;
  for (int y = 0; y < kBlocks; ++y)
    for (int x = 0; x < kBlocks; ++x) {
      std::uint64_t rest = query::block_bits(changed, x, y);
      if (rest == 0) continue;
      const auto slot =
          mesh::slot_at(map, change.address.x * kBlocks + x, change.address.y * kBlocks + y);
      if (slot == mesh::kNoSlot) continue;
      rest &= map.surface_mask[slot];
      count.texels += static_cast<std::uint64_t>(std::popcount(rest));
      for (; rest != 0; rest &= rest - 1)
        count.area +=
            map.area[std::size_t{slot} * 64 + static_cast<std::size_t>(std::countr_zero(rest))];
    }
  return count;
}

std::vector<TileChange> fill_everywhere(const TileMap& tiles, ValueType type,
                                        const mesh::SurfaceMap& map, WrittenValue value) {
  return fill(tiles, type, map, value,
              [&](TileAddress address) { return map.owned_in_tile(address); });
}

std::vector<TileChange> fill_selected(const TileMap& tiles, ValueType type,
                                      const mesh::SurfaceMap& map, query::TexelSelection selection,
                                      WrittenValue value) {
  mesh::spread_to_gutter(map, selection);
  return fill(tiles, type, map, value, [&](TileAddress address) {
    return mesh::gather_tile_bits(map, address,
                                  [&](std::uint32_t slot) { return selection[slot]; });
  });
}

std::vector<TileChange> fill_masks(const TileMap& tiles, ValueType type,
                                   const mesh::SurfaceMap& map,
                                   const std::map<TileAddress, TileMask>& masks,
                                   WrittenValue value) {
  return fill(tiles, type, map, value, [&](TileAddress address) {
    const auto found = masks.find(address);
    return found == masks.end() ? TileMask{} : found->second;
  });
}

std::vector<TileChange> replace_content(const TileMap& tiles, const TileMap& target, ValueType type,
                                        const mesh::SurfaceMap& map) {
  std::set<TileAddress> addresses;
  for (const auto& [address, data] : tiles) addresses.insert(address);
  for (const auto& [address, data] : target) addresses.insert(address);
  std::vector<TileChange> changes;
  for (TileAddress address : addresses) {
    auto before = tile_or_empty(tiles, address, type);
    auto after = std::make_shared<TileData>(*tile_or_empty(target, address, type));
    const TileMask owned = map.owned_in_tile(address);
    TileMask foreign;
    for (int w = 0; w < kMaskWords; ++w) foreign.words[w] = after->valid.words[w] & ~owned.words[w];
    for_each_texel(foreign, [&](int texel) { after->clear(texel); });
    const TileMask written = differing(*before, *after);
    if (written.any()) changes.push_back({address, std::move(before), std::move(after), written});
  }
  return changes;
}

std::vector<TileChange> only_within(std::vector<TileChange> changes,
                                    const std::map<TileAddress, TileMask>& masks) {
  std::vector<TileChange> inside;
  for (TileChange& change : changes) {
    const auto mask = masks.find(change.address);
    if (mask == masks.end()) continue;
    for (int w = 0; w < kMaskWords; ++w) change.written.words[w] &= mask->second.words[w];
    if (!change.written.any()) continue;
    auto after = std::make_shared<TileData>(*change.before);
    copy_texels(*change.after, change.written, *after);
    change.after = std::move(after);
    inside.push_back(std::move(change));
  }
  return inside;
}

std::vector<TileChange> paint_over(const TileMap& tiles, const TileMap& written, ValueType type,
                                   const mesh::SurfaceMap& map) {
  std::vector<TileChange> changes;
  for (const auto& [address, data] : written) {
    const TileMask owned = map.owned_in_tile(address);
    TileMask mask;
    for (int w = 0; w < kMaskWords; ++w) mask.words[w] = data->valid.words[w] & owned.words[w];
    if (!mask.any()) continue;
    auto before = tile_or_empty(tiles, address, type);
    auto after = std::make_shared<TileData>(*before);
    copy_texels(*data, mask, *after);
    changes.push_back({address, std::move(before), std::move(after), mask});
  }
  return changes;
}

std::vector<TileChange> patch_unchanged(const TileMap& tiles, const query::TexelPatch& patch,
                                        ValueType type) {
  std::vector<TileChange> changes;
  for (const auto& [address, tile] : patch.tiles) {
    auto before = tile_or_empty(tiles, address, type);
    const TileMask edited = differing(*before, *tile.before);
    TileMask mask;
    for (int w = 0; w < kMaskWords; ++w) mask.words[w] = tile.texels.words[w] & ~edited.words[w];
    if (!mask.any()) continue;
    auto after = std::make_shared<TileData>(*before);
    copy_texels(*tile.after, mask, *after);
    changes.push_back({address, std::move(before), std::move(after), mask});
  }
  return changes;
}

TileChange painted_change(TileAddress address, std::shared_ptr<const TileData> before,
                          const TileMask& written, const TileData& read_back) {
  auto after = std::make_shared<TileData>(*before);
  copy_texels(read_back, written, *after);
  return {address, std::move(before), std::move(after), written};
}

std::vector<TileAddress> differing_tiles(const TileMap& a, const TileMap& b) {
  std::vector<TileAddress> addresses;
  for (const auto& [address, tile] : a) {
    auto other = b.find(address);
    if (other != b.end() && (other->second == tile || *other->second == *tile)) continue;
    addresses.push_back(address);
  }
  for (const auto& [address, tile] : b)
    if (!a.contains(address)) addresses.push_back(address);
  return addresses;
}

std::vector<store::KeySum> sum_tile(const Layer& layer, const mesh::SurfaceMap& map,
                                    TileAddress address, const TileData& tile) {
  const bool apart = query::tells_keys_apart(layer);
  std::vector<store::KeySum> sums;
  for (const auto& key : query::surface_keys(tile, address, layer, map)) {
    const auto value = static_cast<std::int64_t>(decode_value(layer.type, key.bits));
    sums.push_back({apart ? std::optional(value) : std::nullopt, key.texels, key.area.value(),
                    key.weighted_position, key.lowest, key.highest});
  }
  return sums;
}

}  // namespace strata::room
