#pragma once

#include "domain/layers/layer.h"
#include "domain/layers/tile_mirror.h"
#include "mesh/texels/surface_map.h"
#include "query/conditions/texel_selection.h"

namespace strata::query {

// Returns the total size, in bytes, of the tiles that only one of the two tile maps contains.
std::uint64_t bytes_apart(const TileMap& from, const TileMap& to);

// Adds to `selection` the surface texels of `map` where the value or the validity of the layer
// differs between the tiles `from` and `to`. If the resolutions of layer and map differ, the layer
// texel that contains the center of the map texel is used, as in conditions. Tiles that `from` and
// `to` share are not compared. Stops when the current question ends.
void add_changed_texels(const Layer& layer, const TileMap& from, const TileMap& to,
                        const mesh::SurfaceMap& map, int threads, TexelSelection& selection);

}  // namespace strata::query
