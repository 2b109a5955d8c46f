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
// TileData without a valid texel.
struct TileChange {
  TileAddress address;
  std::shared_ptr<const TileData> before, after;
  TileMask written;
  TileMask provisional{};  // of `written`: texels that wait for review now
};

// Returns the tile of a snapshot, or an empty one of the type.
std::shared_ptr<const TileData> tile_or_empty(const TileMap& tiles, TileAddress address,
                                              ValueType type);

struct ChangeCount {
  std::uint64_t texels = 0;  // surface texels whose value or validity differs
  double area = 0;           // their surface, unit²
};
ChangeCount count_changes(const TileChange& change, const mesh::SurfaceMap& map);

// Returns the sums of each key in the tiles, as the journal stores them.
std::vector<store::TileKeys> sum_tiles(
    const Layer& layer, const mesh::SurfaceMap& map,
    const std::vector<std::pair<TileAddress, std::shared_ptr<const TileData>>>& tiles);

// A value's bits; nothing erases.
using WrittenValue = std::optional<std::uint32_t>;

// Sets the value of every texel of the surface, or erases it.
std::vector<TileChange> fill_everywhere(const TileMap& tiles, ValueType type,
                                        const mesh::SurfaceMap& map, WrittenValue value);
// The same for the selected surface texels and the gutter texels that belong to them.
std::vector<TileChange> fill_selected(const TileMap& tiles, ValueType type,
                                      const mesh::SurfaceMap& map, query::TexelSelection selection,
                                      WrittenValue value);
// The same for the texels of the masks, which belong to the surface or its gutter.
std::vector<TileChange> fill_masks(const TileMap& tiles, ValueType type,
                                   const mesh::SurfaceMap& map,
                                   const std::map<TileAddress, TileMask>& masks,
                                   WrittenValue value);

// Replaces the layer's content by `target`, on the texels of the surface. Only the differences are
// written.
std::vector<TileChange> replace_content(const TileMap& tiles, const TileMap& target, ValueType type,
                                        const mesh::SurfaceMap& map);

// Leaves out what the changes write outside the masks.
std::vector<TileChange> only_within(std::vector<TileChange> changes,
                                    const std::map<TileAddress, TileMask>& masks);

// Paints the valid texels of `written` over the content; skips texels that do not belong to the
// surface.
std::vector<TileChange> paint_over(const TileMap& tiles, const TileMap& written, ValueType type,
                                   const mesh::SurfaceMap& map);

// Returns the change of a tile by a stroke: the texels that it wrote get the value of the GPU; all
// other texels stay unchanged, regardless of the GPU's content.
TileChange painted_change(TileAddress address, std::shared_ptr<const TileData> before,
                          const TileMask& written, const TileData& read_back);

// Returns the tiles that differ.
std::vector<TileAddress> differing_tiles(const TileMap& a, const TileMap& b);

}  // namespace strata::room
