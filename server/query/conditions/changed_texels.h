#pragma once

#include "domain/layers/layer.h"
#include "domain/layers/tile_mirror.h"
#include "mesh/texels/surface_map.h"
#include "query/conditions/texel_selection.h"

namespace strata::query {

// Returns the bytes of tiles that only one of two contents has.
std::uint64_t bytes_apart(const TileMap& from, const TileMap& to);

// Adds to `selection` (of `map`) the surface texels at whose place the value or the validity of the
// layer differs between two contents of it. The layer may have another resolution than the map:
// then the texel that contains the center of the map's texel counts, as in conditions. Tiles that
// both contents share cost nothing. Stops when the question has ended.
void add_changed_texels(const Layer& layer, const TileMap& from, const TileMap& to,
                        const mesh::SurfaceMap& map, int threads, TexelSelection& selection);

}  // namespace strata::query
