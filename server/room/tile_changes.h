#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/history.h"
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

// One tile after the rule of undo and redo was applied to `texels` (core/history.h).
TileChange resolve_change(const TileMap& tiles, TileAddress address, ValueType type,
                          std::span<const PastRevision> newest_first, const TileMask& texels);

}  // namespace strata::room
