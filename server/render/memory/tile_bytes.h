#pragma once

#include <array>
#include <cstdint>

#include "domain/layers/tile.h"

namespace strata::render {

// A tile's valid flags in the layout of textures: one byte per texel, 0 or 1.
using TileFlags = std::array<std::uint8_t, kTexelsPerTile>;

void flags_of(const TileMask& mask, TileFlags& flags);
TileMask mask_of(const TileFlags& flags);

// Writes a valid value to the texels in `mask`: `bits`, in the tile's type. If `erase` is true,
// clears these texels instead.
void write_texels(const TileMask& mask, std::uint32_t bits, bool erase, TileData& tile);

}  // namespace strata::render
