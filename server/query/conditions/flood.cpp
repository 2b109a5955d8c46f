#include "query/conditions/flood.h"

#include <optional>

#include "domain/people/question.h"
#include "query/conditions/tile_table.h"

namespace strata::query {
namespace {

template <class Belongs>
TexelSelection flood(const mesh::SurfaceMap& map, const mesh::TexelGraph& graph,
                     std::uint32_t start, Belongs belongs) {
  TexelSelection selection(map.block_of_slot.size(), 0);
  std::vector<std::uint32_t> open;
  const auto take = [&](std::uint32_t texel) {
    const std::uint64_t bit = std::uint64_t{1} << (texel % 64);
    if ((selection[texel / 64] & bit) != 0 || !belongs(texel)) return;
    selection[texel / 64] |= bit;
    open.push_back(texel);
  };
  take(start);
  const QuestionTurn turn;
  for (std::size_t done = 0; !open.empty(); ++done) {
    if (done % kTexelsPerTile == 0) turn.check(kTexelsPerTile);
    const std::uint32_t texel = open.back();
    open.pop_back();
    mesh::for_each_neighbour(map, graph, texel, take);
  }
  return selection;
}

}  // namespace

TexelSelection select_piece(const mesh::SurfaceMap& map, const mesh::TexelGraph& graph,
                            std::uint32_t start) {
  return flood(map, graph, start, [](std::uint32_t) { return true; });
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
  return flood(map, graph, start,
               [&](std::uint32_t texel) { return value_of(texel) == start_value; });
}

TexelSelection select_near(const mesh::SurfaceMap& map, const mesh::TexelGraph& graph,
                           std::uint32_t start, const glm::vec3& place, float radius) {
  return flood(map, graph, start, [&](std::uint32_t texel) {
    return glm::distance(map.position(texel / 64, static_cast<int>(texel % 64)), place) <= radius;
  });
}

}  // namespace strata::query
