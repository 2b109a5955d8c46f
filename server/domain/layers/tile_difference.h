#pragma once

#include "domain/layers/tile.h"

namespace strata {

// Returns the texels whose value or validity differs between two tiles of the same type.
TileMask differing(const TileData& a, const TileData& b);

}  // namespace strata
