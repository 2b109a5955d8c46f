#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/tile_mirror.h"
#include "mesh/surface_map.h"

namespace strata::room {

// One tile before and after an edit. `before` and `after` are never null; an empty tile is a TileData with nothing valid.
struct TileChange {
  TileAddress address;
  std::shared_ptr<const TileData> before, after;
  TileMask written;
};

// The tile of a snapshot, or an empty one of the type.
std::shared_ptr<const TileData> tile_or_empty(const TileMap& tiles, TileAddress address, ValueType type);

struct ChangeCount {
  std::uint64_t texels = 0;  // surface texels whose value or validity differs
  double area = 0;           // their surface, unit²
};
ChangeCount count_changes(const TileChange& change, const mesh::SurfaceMap& map);

// Every texel of the surface gets the value, or loses what it has.
std::vector<TileChange> fill_everywhere(const TileMap& tiles, ValueType type, const mesh::SurfaceMap& map, bool erase,
                                        std::uint32_t bits);

// The layer's content becomes `wished`, on the texels that belong to the surface. Written is what differs.
std::vector<TileChange> replace_content(const TileMap& tiles, const TileMap& wished, ValueType type,
                                        const mesh::SurfaceMap& map);

// What a stroke did to a tile: the texels it wrote become what the GPU holds there, and nothing else changes, whatever the GPU
// holds in the rest of the tile.
TileChange painted_change(TileAddress address, std::shared_ptr<const TileData> before, const TileMask& written,
                          const TileData& read_back);

// Tiles that are not the same in both.
std::vector<TileAddress> differing_tiles(const TileMap& a, const TileMap& b);

}  // namespace strata::room
