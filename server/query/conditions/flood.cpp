#include "query/conditions/flood.h"

#include <optional>

#include "query/conditions/flood_from.h"
#include "query/conditions/tile_table.h"

namespace strata::query {

TexelSelection select_piece(const mesh::SurfaceMap& map, const mesh::TexelGraph& graph,
                            std::uint32_t start) {
  return flood_from(map, graph, start, [](std::uint32_t) { return true; });
}

TexelSelection select_connected(const mesh::SurfaceMap& map, const mesh::TexelGraph& graph,
                                const TileMap& tiles, std::uint32_t start) {
  const TileTable table(tiles, map.resolution);
  const auto value_of = [&](std::uint32_t texel) -> std::optional<std::uint32_t> {
    const auto block = static_cast<int>(map.block_of_slot[texel / 64]),
               i = static_cast<int>(texel % 64);
    const int x = block % map.blocks_per_side * kBlockSize + i % kBlockSize,
              y = block / map.blocks_per_side * kBlockSize + i / kBlockSize;
    const TileData* tile = table.of_texel(x, y);
    const int in_tile = y % kTileSize * kTileSize + x % kTileSize;
    if (tile == nullptr || !tile->valid.test(in_tile)) return std::nullopt;
    return tile->bits(in_tile);
  };
  const auto start_value = value_of(start);
  return flood_from(map, graph, start,
                    [&](std::uint32_t texel) { return value_of(texel) == start_value; });
}

TexelSelection select_near(const mesh::SurfaceMap& map, const mesh::TexelGraph& graph,
                           std::uint32_t start, const glm::vec3& place, float radius) {
  return flood_from(map, graph, start, [&](std::uint32_t texel) {
    return glm::distance(map.position(texel / 64, static_cast<int>(texel % 64)), place) <= radius;
  });
}

}  // namespace strata::query
