#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>

#include "domain/layers/tile_mirror.h"

namespace strata {

// Returns the bits of the texel at a texture coordinate, which is clamped to the atlas (row 0 is at
// v = 0). Returns nullopt if the texel is not valid.
std::optional<std::uint32_t> bits_at(const TileMap& tiles, int resolution, glm::vec2 uv);

}  // namespace strata
