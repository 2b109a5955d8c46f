#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <functional>
#include <vector>

#include "domain/layers/value_type.h"

namespace strata {

// A tile (page) is 128 × 128 texels, the unit of storage, read-back and the journal. A block is
// 8 × 8 texels, the unit of culling. Texel (0,0) is at the lower left of the atlas (uv origin), and
// rows go upward. All data is row-major: the index of a texel in its tile is y * 128 + x.
constexpr int kTileSize = 128;
constexpr int kTexelsPerTile = kTileSize * kTileSize;
constexpr int kBlockSize = 8;
constexpr int kMaskWords = kTexelsPerTile / 64;

struct TileAddress {
  std::uint16_t x = 0;
  std::uint16_t y = 0;
  auto operator<=>(const TileAddress&) const = default;
};

// One bit per texel; bit (i & 63) of word (i >> 6) is texel i.
struct TileMask {
  std::array<std::uint64_t, kMaskWords> words{};

  bool test(int texel) const { return (words[texel >> 6] >> (texel & 63)) & 1u; }
  void set(int texel) { words[texel >> 6] |= std::uint64_t{1} << (texel & 63); }
  void reset(int texel) { words[texel >> 6] &= ~(std::uint64_t{1} << (texel & 63)); }
  bool any() const;
  int count() const;
  bool operator==(const TileMask&) const = default;
};

// The content of a tile. `values` holds kTexelsPerTile little-endian texels. An invalid texel is
// stored as 0.
struct TileData {
  std::vector<std::uint8_t> values;
  TileMask valid;

  TileData() = default;
  explicit TileData(ValueType type)
      : values(std::size_t{kTexelsPerTile} * strata::bytes_per_texel(type)) {}
  bool operator==(const TileData&) const = default;

  std::uint32_t bits(int texel) const;        // bits of the texel; 0 if it is invalid
  void write(int texel, std::uint32_t bits);  // sets the value and the valid flag
  void clear(int texel);                      // erases: value 0, invalid
  int texel_bytes() const { return static_cast<int>(values.size() / kTexelsPerTile); }
};

// Copies the bits into texels of another type, which must be wide enough (widens_to).
TileData widened(const TileData& tile, ValueType type);

// Copies the texels in `mask`. Both tiles must have the same type.
void copy_texels(const TileData& from, const TileMask& mask, TileData& to);

}  // namespace strata

template <>
struct std::hash<strata::TileAddress> {
  std::size_t operator()(strata::TileAddress a) const noexcept {
    return (std::size_t{a.y} << 16) | a.x;
  }
};
