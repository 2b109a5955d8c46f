#include <gtest/gtest.h>

#include <random>

#include "domain/layers/revision.h"
#include "domain/layers/tile_mirror.h"

namespace strata {
namespace {

constexpr ValueType kTypes[] = {ValueType::u8, ValueType::u16, ValueType::u32};

TileData random_tile(ValueType type, std::mt19937& random, double share) {
  TileData tile(type);
  std::bernoulli_distribution painted(share);
  const std::uint32_t mask =
      bytes_per_texel(type) == 4 ? ~0u : (1u << (8 * bytes_per_texel(type))) - 1;
  for (int i = 0; i < kTexelsPerTile; ++i)
    if (painted(random)) tile.write(i, random() & mask);
  return tile;
}

TEST(Revision, goes_forward_and_backward) {
  std::mt19937 random(1);
  for (ValueType type : kTypes) {
    const TileData before = random_tile(type, random, 0.3), after = random_tile(type, random, 0.4);
    const TileRevision revision = make_revision({3, 4}, before, after, {});
    TileData tile = before;
    apply(revision, tile);
    EXPECT_EQ(tile, after);
    apply(revision, tile);
    EXPECT_EQ(tile, before);
  }
}

TEST(Revision, survives_its_storage_form) {
  std::mt19937 random(2);
  for (ValueType type : kTypes) {
    TileRevision revision =
        make_revision({7, 9}, random_tile(type, random, 0.1), random_tile(type, random, 0.1), {});
    for (int i = 0; i < 500; ++i) revision.written.set(static_cast<int>(random() % kTexelsPerTile));
    auto decoded = decode_revision({7, 9}, type, encode_revision(revision));
    ASSERT_TRUE(decoded);
    EXPECT_EQ(*decoded, revision);
    const TileData tile = random_tile(type, random, 0.5);
    EXPECT_EQ(decode_tile(type, encode_tile(tile)).value(), tile);
  }
}

TEST(Revision, damaged_bytes_are_a_problem_and_never_a_crash) {
  std::mt19937 random(3);
  const auto good = encode_tile(random_tile(ValueType::u16, random, 0.2));
  EXPECT_FALSE(decode_tile(ValueType::u8, good));           // different width
  EXPECT_FALSE(decode_revision({}, ValueType::u16, good));  // different kind
  for (std::size_t size = 0; size < good.size(); size += 1 + size / 7)
    EXPECT_FALSE(decode_tile(ValueType::u16, std::span(good).first(size))) << size;
  for (int i = 0; i < 300; ++i) {
    auto bad = good;
    bad[random() % bad.size()] ^= static_cast<std::uint8_t>(1u << (random() % 8));
    // Damaged bytes may decode to other texels, but the decoder must not crash or read out of
    // bounds.
    (void)decode_tile(ValueType::u16, bad);
  }
}

TEST(Revision, a_small_stroke_is_stored_in_few_bytes) {
  TileData before(ValueType::u8), after(ValueType::u8);
  TileMask written;
  for (int y = 40; y < 60; ++y)
    for (int x = 40; x < 60; ++x) {
      after.write(y * kTileSize + x, 5);
      written.set(y * kTileSize + x);
    }
  EXPECT_LT(encode_revision(make_revision({}, before, after, written)).size(), 600u);
}

TEST(TileMirror, drops_tiles_that_end_empty_and_keeps_old_snapshots) {
  TileMirror mirror(ValueType::u8, 2048);
  auto painted = std::make_shared<TileData>(ValueType::u8);
  painted->write(5, 9);
  mirror.put({{{1, 2}, painted}}, 1);
  const auto old = mirror.snapshot();
  mirror.put({{{1, 2}, std::make_shared<TileData>(ValueType::u8)}}, 2);
  EXPECT_EQ(mirror.tile({1, 2}), nullptr);
  EXPECT_EQ(mirror.sequence(), 2);
  EXPECT_EQ(old.tiles.at({1, 2})->bits(5), 9u);
  EXPECT_EQ(old.sequence, 1);
}

}  // namespace
}  // namespace strata
