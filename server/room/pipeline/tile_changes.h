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
#include "query/regions/surface_values.h"
#include "store/journal/journal.h"

namespace strata::room {

// One tile before and after an edit. `before` and `after` are never null. An empty tile is a
// TileData without a valid texel.
struct TileChange {
  TileAddress address;
  std::shared_ptr<const TileData> before, after;
  TileMask written;
  TileMask provisional{};  // texels of `written` that now wait for review
};

// Returns the tile of a snapshot. If there is no such tile, returns an empty tile of the type.
std::shared_ptr<const TileData> tile_or_empty(const TileMap& tiles, TileAddress address,
                                              ValueType type);

struct ChangeCount {
  std::uint64_t texels = 0;  // surface texels whose value or validity differs
  double area = 0;           // area of these texels, in unit²
};
ChangeCount count_changes(const TileChange& change, const mesh::SurfaceMap& map);

// Returns the sums for each key in the tile, in the form that the journal stores.
std::vector<store::KeySum> sum_tile(const Layer& layer, const mesh::SurfaceMap& map,
                                    TileAddress address, const TileData& tile);

// The bits of a value. nullopt erases.
using WrittenValue = std::optional<std::uint32_t>;

// Sets the value of every texel of the surface, or erases it.
std::vector<TileChange> fill_everywhere(const TileMap& tiles, ValueType type,
                                        const mesh::SurfaceMap& map, WrittenValue value);
// Like `fill_everywhere`, for the selected surface texels and their gutter texels.
std::vector<TileChange> fill_selected(const TileMap& tiles, ValueType type,
                                      const mesh::SurfaceMap& map, query::TexelSelection selection,
                                      WrittenValue value);
// Like `fill_selected`, for the texels of the masks, which must belong to surface or gutter.
std::vector<TileChange> fill_masks(const TileMap& tiles, ValueType type,
                                   const mesh::SurfaceMap& map,
                                   const std::map<TileAddress, TileMask>& masks,
                                   WrittenValue value);

// Replaces the content of the layer by `target`, on the texels of the surface. Writes only the
// texels that differ.
std::vector<TileChange> replace_content(const TileMap& tiles, const TileMap& target, ValueType type,
                                        const mesh::SurfaceMap& map);

// Removes changes outside the masks.
std::vector<TileChange> only_within(std::vector<TileChange> changes,
                                    const std::map<TileAddress, TileMask>& masks);

// Paints the valid texels of `written` over the content. Skips texels that do not belong to the
// surface.
std::vector<TileChange> paint_over(const TileMap& tiles, const TileMap& written, ValueType type,
                                   const mesh::SurfaceMap& map);

// Writes the texels of the patch that still have the value from which it was computed. Texels with
// another value stay as they are.
std::vector<TileChange> patch_unchanged(const TileMap& tiles, const query::TexelPatch& patch,
                                        ValueType type);

// Returns the change of a tile by a stroke. The texels that the stroke wrote get the value from the
// GPU. All other texels stay unchanged, regardless of the content on the GPU.
TileChange painted_change(TileAddress address, std::shared_ptr<const TileData> before,
                          const TileMask& written, const TileData& read_back);

// Returns the tiles that differ.
std::vector<TileAddress> differing_tiles(const TileMap& a, const TileMap& b);

}  // namespace strata::room
