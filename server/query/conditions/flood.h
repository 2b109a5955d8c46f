#pragma once

#include "domain/layers/tile_mirror.h"
#include "mesh/texels/texel_graph.h"
#include "query/conditions/texel_selection.h"

namespace strata::query {

// Selections of texels that are connected across the surface to a given surface texel (numbered as
// in TexelGraph), without gutter texels.

// Selects the whole connected piece of the surface.
TexelSelection select_piece(const mesh::SurfaceMap& map, const mesh::TexelGraph& graph,
                            std::uint32_t start);

// Selects the connected texels with the same value as `start`, or those without a value if `start`
// has no value. `tiles` belong to a layer with the resolution of the map.
TexelSelection select_connected(const mesh::SurfaceMap& map, const mesh::TexelGraph& graph,
                                const TileMap& tiles, std::uint32_t start);

// Selects the texels within `radius` (model units, Euclidean distance) of `place`, the position of
// `start`. Only texels connected to `start` within that distance are selected, not the other side
// of a thin wall.
TexelSelection select_near(const mesh::SurfaceMap& map, const mesh::TexelGraph& graph,
                           std::uint32_t start, const glm::vec3& place, float radius);

}  // namespace strata::query
