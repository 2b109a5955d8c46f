#include <gtest/gtest.h>

#include <random>

#include "render/memory/tile_bytes.h"

namespace strata::render {
namespace {

// Returns a mask of full, empty and random words.
TileMask random_mask(unsigned seed) {
  std::mt19937_64 random(seed);
  TileMask mask;
  for (auto& word : mask.words)
    word = random() % 3 == 0 ? ~std::uint64_t{0} : random() % 2 == 0 ? 0 : random();
  return mask;
}

TEST(TileBytes, flags_are_one_where_the_mask_has_a_bit_and_come_back_as_they_were) {
  const TileMask mask = random_mask(1);
  TileFlags flags;
  flags.fill(0xcc);
  flags_of(mask, flags);
  for (int i = 0; i < kTexelsPerTile; ++i)
    ASSERT_EQ(flags[std::size_t(i)], mask.test(i) ? 1 : 0) << "texel " << i;
  EXPECT_TRUE(mask_of(flags) == mask);
}

TEST(TileBytes, texels_are_written_and_erased_as_one_by_one) {
  for (const auto type : {ValueType::u8, ValueType::i16, ValueType::f32}) {
    const std::uint32_t bits = type == ValueType::u8    ? 0xfeu
                               : type == ValueType::i16 ? 0xfedcu
                                                        : 0xfedcba98u;
    TileData tile(type);
    for (int i = 0; i < kTexelsPerTile; i += 3) tile.write(i, 5);
    TileData expected = tile;
    const TileMask painted = random_mask(2), erased = random_mask(3);
    write_texels(painted, bits, false, tile);
    write_texels(erased, bits, true, tile);
    for (int i = 0; i < kTexelsPerTile; ++i) {
      if (painted.test(i)) expected.write(i, bits);
      if (erased.test(i)) expected.clear(i);
    }
    EXPECT_TRUE(tile == expected) << "type " << name(type);
  }
}

}  // namespace
}  // namespace strata::render
