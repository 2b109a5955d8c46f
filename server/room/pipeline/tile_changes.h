#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "domain/layers/layer.h"
#include "domain/layers/tile_mirror.h"
#include "mesh/texels/surface_map.h"
#include "query/conditions/texel_selection.h"
#include "store/journal/journal.h"

namespace strata::room {

// One tile before and after an edit. `before` and `after` are never null; an empty tile is a
// TileData with nothing valid.
struct TileChange {
  TileAddress address;
  std::shared_ptr<const TileData> before, after;
  TileMask written;
  TileMask provisional{};  // of `written`: what waits for review now
};

// The tile of a snapshot, or an empty one of the type.
std::shared_ptr<const TileData> tile_or_empty(const TileMap& tiles, TileAddress address,
                                              ValueType type);

struct ChangeCount {
  std::uint64_t texels = 0;  // surface texels whose value or validity differs
  double area = 0;           // their surface, unit²
};
ChangeCount count_changes(const TileChange& change, const mesh::SurfaceMap& map);

// What the tiles hold of each key, as the journal keeps it.
std::vector<store::TileKeys> sum_tiles(
    const Layer& layer, const mesh::SurfaceMap& map,
    const std::vector<std::pair<TileAddress, std::shared_ptr<const TileData>>>& tiles);

// What is written: a value's bits, or nothing, which erases.
using WrittenValue = std::optional<std::uint32_t>;

// Every texel of the surface gets the value, or loses what it has.
std::vector<TileChange> fill_everywhere(const TileMap& tiles, ValueType type,
                                        const mesh::SurfaceMap& map, WrittenValue value);
// The selected surface texels do, and the gutter texels that follow them.
std::vector<TileChange> fill_selected(const TileMap& tiles, ValueType type,
                                      const mesh::SurfaceMap& map, query::TexelSelection selection,
                                      WrittenValue value);
// The texels of the masks, which belong to the surface or its gutter.
std::vector<TileChange> fill_masks(const TileMap& tiles, ValueType type,
                                   const mesh::SurfaceMap& map,
                                   const std::map<TileAddress, TileMask>& masks,
                                   WrittenValue value);

// The layer's content becomes `wished`, on the texels that belong to the surface. Written is what
// differs.
std::vector<TileChange> replace_content(const TileMap& tiles, const TileMap& wished, ValueType type,
                                        const mesh::SurfaceMap& map);

// What is valid in `written` is painted over what is there; texels that do not belong to the
// surface are passed over.
std::vector<TileChange> paint_over(const TileMap& tiles, const TileMap& written, ValueType type,
                                   const mesh::SurfaceMap& map);

// What a stroke did to a tile: the texels it wrote become what the GPU holds there, and nothing
// else changes, whatever the GPU holds in the rest of the tile.
TileChange painted_change(TileAddress address, std::shared_ptr<const TileData> before,
                          const TileMask& written, const TileData& read_back);

// Tiles that are not the same in both.
std::vector<TileAddress> differing_tiles(const TileMap& a, const TileMap& b);

}  // namespace strata::room
