#include "domain/layers/tile_difference.h"

#include <cstring>

namespace strata {

TileMask differing(const TileData& a, const TileData& b) {
  TileMask mask;
  const auto width = static_cast<std::size_t>(a.texel_bytes());
  for (std::size_t w = 0; w < kMaskWords; ++w) mask.words[w] = a.valid.words[w] ^ b.valid.words[w];
  if (std::memcmp(a.values.data(), b.values.data(), a.values.size()) == 0) return mask;
  for (int texel = 0; texel < kTexelsPerTile; ++texel) {
    const std::size_t first = static_cast<std::size_t>(texel) * width;
    if (std::memcmp(&a.values[first], &b.values[first], width) != 0) mask.set(texel);
  }
  return mask;
}

}  // namespace strata
