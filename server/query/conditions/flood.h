#pragma once

#include "domain/layers/tile_mirror.h"
#include "mesh/texels/texel_graph.h"
#include "query/conditions/texel_selection.h"

namespace strata::query {

// What is connected across the surface with a surface texel (numbered as in TexelGraph), gutter
// texels left out.

// The whole piece of the surface.
TexelSelection select_piece(const mesh::SurfaceMap& map, const mesh::TexelGraph& graph,
                            std::uint32_t start);

// What holds the same value as it, or like it none. `tiles` are a layer's of the map's resolution.
TexelSelection select_connected(const mesh::SurfaceMap& map, const mesh::TexelGraph& graph,
                                const TileMap& tiles, std::uint32_t start);

// What lies within `radius` (model units, straight) of `place` and is connected with `start`, which
// is there, within that distance: the other side of a thin wall is not.
TexelSelection select_near(const mesh::SurfaceMap& map, const mesh::TexelGraph& graph,
                           std::uint32_t start, const glm::vec3& place, float radius);

}  // namespace strata::query
