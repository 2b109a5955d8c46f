#include "domain/layers/tile.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace strata {

bool TileMask::any() const {
  return std::any_of(words.begin(), words.end(), [](std::uint64_t word) { return word != 0; });
}

int TileMask::count() const {
  int sum = 0;
  for (auto word : words) sum += std::popcount(word);
  return sum;
}

std::uint32_t TileData::bits(int texel) const {
  const int width = texel_bytes();
  std::uint32_t out = 0;
  std::memcpy(&out, values.data() + std::size_t(texel) * width, width);
  return out;
}

void TileData::write(int texel, std::uint32_t bits) {
  const int width = texel_bytes();
  std::memcpy(values.data() + std::size_t(texel) * width, &bits, width);
  valid.set(texel);
}

void TileData::clear(int texel) {
  const int width = texel_bytes();
  std::memset(values.data() + std::size_t(texel) * width, 0, width);
  valid.reset(texel);
}

TileData widened(const TileData& tile, ValueType type) {
  TileData wide(type);
  wide.valid = tile.valid;
  const auto from = static_cast<std::size_t>(tile.texel_bytes()),
             to = static_cast<std::size_t>(wide.texel_bytes());
  for (std::size_t texel = 0; texel < kTexelsPerTile; ++texel)
    std::copy_n(tile.values.begin() + static_cast<std::ptrdiff_t>(texel * from), from,
                wide.values.begin() + static_cast<std::ptrdiff_t>(texel * to));
  return wide;
}

void copy_texels(const TileData& from, const TileMask& mask, TileData& to) {
  for (int w = 0; w < kMaskWords; ++w)
    for (std::uint64_t left = mask.words[w]; left; left &= left - 1) {
      const int texel = w * 64 + std::countr_zero(left);
      if (from.valid.test(texel))
        to.write(texel, from.bits(texel));
      else
        to.clear(texel);
    }
}

}  // namespace strata
