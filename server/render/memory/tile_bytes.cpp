#include "render/memory/tile_bytes.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace strata::render {
namespace {

static_assert(std::endian::native == std::endian::little, "byte i of a word is its texel i");

// Makes a table that spreads eight bits to the lowest bits of eight bytes.
constexpr std::array<std::uint64_t, 256> make_spread() {
  std::array<std::uint64_t, 256> spread{};
  for (std::size_t bits = 0; bits < spread.size(); ++bits)
    for (std::size_t i = 0; i < 8; ++i) spread[bits] |= std::uint64_t{bits >> i & 1} << (8 * i);
  return spread;
}
constexpr auto kSpread = make_spread();

// Processes eight texels at a time, because usually all or none of them are written.
template <class Texel>
void fill_texels(const TileMask& mask, Texel value, std::uint8_t* values) {
  std::array<Texel, 8> run;
  run.fill(value);
  for (std::size_t i = 0; i < kTexelsPerTile / run.size(); ++i) {
    auto bits = static_cast<std::uint32_t>(mask.words[i / 8] >> (i % 8 * 8) & 0xff);
    std::uint8_t* const first = values + i * sizeof run;
    if (bits == 0xff) {
      std::memcpy(first, run.data(), sizeof run);
      continue;
    }
    for (; bits != 0; bits &= bits - 1)
      std::memcpy(first + static_cast<std::size_t>(std::countr_zero(bits)) * sizeof value, &value,
                  sizeof value);
  }
}

}  // namespace

void flags_of(const TileMask& mask, TileFlags& flags) {
  for (std::size_t i = 0; i < flags.size() / 8; ++i) {
    const std::uint64_t eight = kSpread[mask.words[i / 8] >> (i % 8 * 8) & 0xff];
    std::memcpy(flags.data() + i * 8, &eight, sizeof eight);
  }
}

TileMask mask_of(const TileFlags& flags) {
  TileMask mask;
  for (std::size_t i = 0; i < flags.size() / 8; ++i) {
    std::uint64_t eight;
    std::memcpy(&eight, flags.data() + i * 8, sizeof eight);
    mask.words[i / 8] |= (eight * 0x0102040810204080u >> 56) << (i % 8 * 8);
  }
  return mask;
}

void write_texels(const TileMask& mask, std::uint32_t bits, bool erase, TileData& tile) {
  if (erase) bits = 0;
  switch (tile.texel_bytes()) {
    case 1: fill_texels(mask, static_cast<std::uint8_t>(bits), tile.values.data()); break;
    case 2: fill_texels(mask, static_cast<std::uint16_t>(bits), tile.values.data()); break;
    default: fill_texels(mask, bits, tile.values.data()); break;
  }
  for (std::size_t word = 0; word < mask.words.size(); ++word) {
    std::uint64_t& valid = tile.valid.words[word];
    valid = erase ? valid & ~mask.words[word] : valid | mask.words[word];
  }
}

}  // namespace strata::render
