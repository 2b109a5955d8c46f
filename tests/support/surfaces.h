#pragma once

#include <bit>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "domain/layers/tile_mirror.h"
#include "mesh/atlas/atlas.h"
#include "mesh/surface/geometry.h"
#include "mesh/texels/texel_graph.h"

// A mesh with all data for queries of its surface, and layers on that surface.
namespace strata::test {

struct Surface {
  std::string name;
  mesh::Geometry geometry;
  mesh::SurfaceMap map;
  mesh::TexelGraph graph;
};

inline Surface surface_of(std::string name, const mesh::TriangleMesh& mesh, int resolution) {
  Progress progress;
  Surface surface;
  surface.name = std::move(name);
  surface.geometry = mesh::build_geometry(mesh, *mesh::make_atlas(mesh, resolution, progress));
  surface.map = *mesh::bake_surface_map(surface.geometry, resolution, progress);
  surface.graph = *mesh::build_texel_graph(surface.geometry, surface.map, progress);
  return surface;
}

template <class Visit>
void for_each_surface_texel(const mesh::SurfaceMap& map, Visit visit) {
  for (std::uint32_t slot = 0; slot < map.block_of_slot.size(); ++slot)
    for (std::uint64_t left = map.surface_mask[slot]; left != 0; left &= left - 1)
      visit(slot * 64 + static_cast<std::uint32_t>(std::countr_zero(left)));
}

// Returns a layer with the result of `value_at` for the position of each texel. Gutter texels get
// values too.
inline TileMap layer_of(const mesh::SurfaceMap& map,
                        const std::function<int(glm::vec3)>& value_at) {
  TileMap tiles;
  for (int y = 0; y < map.resolution / kTileSize; ++y)
    for (int x = 0; x < map.resolution / kTileSize; ++x) {
      auto tile = std::make_shared<TileData>(ValueType::u8);
      for (int i = 0; i < kTexelsPerTile; ++i) {
        const int tx = x * kTileSize + i % kTileSize, ty = y * kTileSize + i / kTileSize;
        const auto slot = map.slot_of_block[std::size_t(ty / 8) * map.blocks_per_side + tx / 8];
        const int texel = ty % 8 * 8 + tx % 8;
        if (slot == mesh::kNoSlot ||
            map.packed_position[std::size_t{slot} * 64 + texel] == mesh::kNoPosition)
          continue;
        if (const int value = value_at(map.position(slot, texel)))
          tile->write(i, static_cast<std::uint32_t>(value));
      }
      if (tile->valid.any())
        tiles[{static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y)}] = tile;
    }
  return tiles;
}

}  // namespace strata::test
