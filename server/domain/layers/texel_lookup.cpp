#include "domain/layers/texel_lookup.h"

#include <algorithm>
#include <cmath>

namespace strata {

std::optional<std::uint32_t> bits_at(const TileMap& tiles, int resolution, glm::vec2 uv) {
  const auto texel = [resolution](float coordinate) {
    const float scaled = std::floor(coordinate * static_cast<float>(resolution));
    return std::isfinite(scaled)
               ? static_cast<int>(std::clamp(scaled, 0.0f, static_cast<float>(resolution - 1)))
               : 0;
  };
  const int x = texel(uv.x), y = texel(uv.y);
  const auto found = tiles.find(
      {static_cast<std::uint16_t>(x / kTileSize), static_cast<std::uint16_t>(y / kTileSize)});
  if (found == tiles.end() || !found->second) return std::nullopt;
  const int in_tile = (y % kTileSize) * kTileSize + x % kTileSize;
  if (!found->second->valid.test(in_tile)) return std::nullopt;
  return found->second->bits(in_tile);
}

}  // namespace strata
