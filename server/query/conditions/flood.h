#pragma once

#include "domain/layers/tile_mirror.h"
#include "mesh/texels/texel_graph.h"
#include "query/conditions/texel_selection.h"

namespace strata::query {

// Selections of texels that are connected across the surface with a given surface texel (numbered
// as in TexelGraph), without gutter texels.

// Selects the whole connected piece of the surface.
TexelSelection select_piece(const mesh::SurfaceMap& map, const mesh::TexelGraph& graph,
                            std::uint32_t start);

// Selects the connected texels with the same value as `start`, or without a value if it has none.
// `tiles` belong to a layer of the map's resolution.
TexelSelection select_connected(const mesh::SurfaceMap& map, const mesh::TexelGraph& graph,
                                const TileMap& tiles, std::uint32_t start);

// Selects the texels within `radius` (model units, Euclidean) of `place` that are connected with
// `start`, which is at `place`, within that distance: this excludes the other side of a thin wall.
TexelSelection select_near(const mesh::SurfaceMap& map, const mesh::TexelGraph& graph,
                           std::uint32_t start, const glm::vec3& place, float radius);

}  // namespace strata::query
