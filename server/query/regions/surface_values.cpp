#include "query/regions/surface_values.h"

#include <bit>

#include "core/compensated_sum.h"
#include "core/progress.h"
#include "domain/layers/mask_texels.h"
#include "mesh/texels/slot_bits.h"
#include "query/conditions/texel_values.h"

namespace strata::query {
namespace {

template <class Bits>
void read_tile(const TileData& tile, TileAddress address, const mesh::SurfaceMap& map,
               SurfaceValues& values) {
  for_each_block_of(tile, address, map, nullptr,
                    [&](std::uint32_t slot, std::uint64_t texels, int corner) {
                      values.valid[slot] = texels;
                      for (; texels != 0; texels &= texels - 1) {
                        const int texel = std::countr_zero(texels);
                        values.bits[std::size_t{slot} * 64 + static_cast<std::size_t>(texel)] =
                            bits_in_block<Bits>(tile, corner, texel);
                      }
                    });
}

// Returns the surface texels whose values differ, and adds up their areas. Fails when cancelled.
Result<std::vector<std::uint64_t>> find_changed(const SurfaceValues& before,
                                                const SurfaceValues& after,
                                                const mesh::SurfaceMap& map, TexelPatch& patch,
                                                const Progress& progress) {
  std::vector<std::uint64_t> changed(map.block_of_slot.size(), 0);
  CompensatedSum area;
  for (std::uint32_t slot = 0; slot < changed.size(); ++slot) {
    if (slot % 4096 == 0 && progress.cancelled()) return cancelled_problem();
    for (std::uint64_t left = map.surface_mask[slot]; left != 0; left &= left - 1) {
      const int i = std::countr_zero(left);
      const std::uint32_t texel = slot * 64 + static_cast<std::uint32_t>(i);
      if (before.of(texel) == after.of(texel)) continue;
      changed[slot] |= std::uint64_t{1} << i;
      ++patch.texels;
      area += map.area[texel];
    }
  }
  patch.area = area.value();
  return changed;
}

std::shared_ptr<const TileData> tile_of(const TileMap& tiles, TileAddress address, ValueType type) {
  const auto found = tiles.find(address);
  if (found != tiles.end() && found->second) return found->second;
  return std::make_shared<const TileData>(type);
}

}  // namespace

SurfaceValues read_surface_values(const TileMap& tiles, ValueType type,
                                  const mesh::SurfaceMap& map) {
  const std::size_t slots = map.block_of_slot.size();
  SurfaceValues values{std::vector<std::uint32_t>(slots * 64), std::vector<std::uint64_t>(slots)};
  for (const auto& [address, tile] : tiles) {
    if (!tile) continue;
    switch (bytes_per_texel(type)) {
      case 1: read_tile<std::uint8_t>(*tile, address, map, values); break;
      case 2: read_tile<std::uint16_t>(*tile, address, map, values); break;
      default: read_tile<std::uint32_t>(*tile, address, map, values);
    }
  }
  return values;
}

Result<TexelPatch> make_patch(const TileMap& tiles, ValueType type, const mesh::SurfaceMap& map,
                              SurfaceValues after, const Progress& progress) {
  TexelPatch patch;
  auto changed =
      STRATA_TRY(find_changed(read_surface_values(tiles, type, map), after, map, patch, progress));
  if (patch.texels == 0) return patch;
  mesh::for_each_gutter_texel(map, [&](mesh::SlotTexel gutter, mesh::SlotTexel owner) {
    if ((changed[owner.slot] >> owner.texel & 1u) == 0) return;
    changed[gutter.slot] |= std::uint64_t{1} << gutter.texel;
    after.set(gutter.slot * 64 + static_cast<std::uint32_t>(gutter.texel),
              after.of(owner.slot * 64 + static_cast<std::uint32_t>(owner.texel)));
  });
  const int tiles_per_side = map.resolution / kTileSize;
  for (int y = 0; y < tiles_per_side; ++y) {
    if (progress.cancelled()) return cancelled_problem();
    for (int x = 0; x < tiles_per_side; ++x) {
      const TileAddress address{static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y)};
      const TileMask mask =
          mesh::gather_tile_bits(map, address, [&](std::uint32_t slot) { return changed[slot]; });
      if (!mask.any()) continue;
      auto before = tile_of(tiles, address, type);
      auto data = std::make_shared<TileData>(*before);
      for_each_texel(mask, [&](int texel) {
        const mesh::SlotTexel at = mesh::slot_texel(map, address, texel);
        const TexelValue value = after.of(at.slot * 64 + static_cast<std::uint32_t>(at.texel));
        value.valid ? data->write(texel, value.bits) : data->clear(texel);
      });
      patch.tiles[address] = {mask, std::move(before), std::move(data)};
    }
  }
  return patch;
}

Result<TileMap> make_tiles(ValueType type, const mesh::SurfaceMap& map, SurfaceValues values,
                           const Progress& progress) {
  auto patch = STRATA_TRY(make_patch({}, type, map, std::move(values), progress));
  TileMap tiles;
  for (auto& [address, tile] : patch.tiles) tiles[address] = std::move(tile.after);
  return tiles;
}

}  // namespace strata::query
