#pragma once

#include "core/error.h"
#include "core/progress.h"
#include "domain/layers/tile_mirror.h"
#include "mesh/texels/surface_map.h"
#include "query/sampling/texel_appearance.h"

namespace strata::query {

// Returns the lightness of each surface texel of the map, 0…100 (L* of CIELAB), as values of
// `type`, rounded for integer types. A texel that is more than half transparent
// has no value. `colors` belong to the map.
// Fails when cancelled.
Result<TileMap> lightness_tiles(const TexelAppearance& colors, const mesh::SurfaceMap& map,
                                ValueType type, Progress& progress);

}  // namespace strata::query
