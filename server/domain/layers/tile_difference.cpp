#include "domain/layers/tile_difference.h"

#include <cstring>

namespace strata {

TileMask differing(const TileData& a, const TileData& b) {
  TileMask mask;
  const auto width = static_cast<std::size_t>(a.texel_bytes());
  for (std::size_t w = 0; w < kMaskWords; ++w) {
    mask.words[w] = a.valid.words[w] ^ b.valid.words[w];
    // Most edits change few texels of a tile, and a comparison of 64 texels takes as long as one of
    // a single texel.
    const std::size_t first = 64 * w * width;
    if (std::memcmp(&a.values[first], &b.values[first], 64 * width) == 0) continue;
    for (std::size_t bit = 0; bit < 64; ++bit) {
      const std::size_t texel = first + bit * width;
      if (std::memcmp(&a.values[texel], &b.values[texel], width) != 0)
        mask.words[w] |= std::uint64_t{1} << bit;
    }
  }
  return mask;
}

}  // namespace strata
