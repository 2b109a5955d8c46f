#include <gtest/gtest.h>

#include <map>
#include <random>

#include "domain/layers/history.h"
#include "domain/layers/tile_segment.h"

namespace strata {
namespace {

constexpr TileAddress kAddress{5, 6};

// Paints, erases and imports into one tile, as strokes and other edits do.
class Paint {
 public:
  Paint(ValueType type, unsigned seed) : random_(seed), tile_(type) {}

  TileSegment::Entry next() {
    const TileData before = tile_;
    TileMask written;
    const int kind = static_cast<int>(random_() % 4);
    const int x0 = pick(100), y0 = pick(100), size = 1 + pick(28);
    const std::uint32_t bits = random_() & 0x7f;
    for (int y = y0; y < y0 + size; ++y)
      for (int x = x0; x < x0 + size; ++x) {
        const int texel = y * kTileSize + x;
        written.set(texel);
        if (kind == 0 || (kind == 3 && random_() % 3 == 0))
          tile_.clear(texel);
        else
          tile_.write(texel, kind == 3 ? random_() & 0x7f : bits);
      }
    sequence_ += 1 + static_cast<std::int64_t>(random_() % 3);
    return {sequence_, make_revision(kAddress, before, tile_, written)};
  }
  const TileData& tile() const { return tile_; }
  std::int64_t sequence() const { return sequence_; }

 private:
  int pick(int below) { return static_cast<int>(random_() % static_cast<unsigned>(below)); }
  std::mt19937 random_;
  TileData tile_;
  std::int64_t sequence_ = 10;
};

TEST(TileSegment, survives_its_storage_form_and_reads_at_every_sequence) {
  for (const ValueType type : {ValueType::u8, ValueType::i16, ValueType::f32}) {
    Paint paint(type, 3);
    for (int i = 0; i < 5; ++i) (void)paint.next();
    TileSegment segment{paint.tile(), {}};
    std::map<std::int64_t, TileData> states{{paint.sequence(), paint.tile()}};
    while (segment.entries.size() < TileSegment::kMaxRevisions) {
      segment.entries.push_back(paint.next());
      states[paint.sequence()] = paint.tile();
    }
    const auto stored = encode_segment(segment);
    ASSERT_TRUE(stored);
    const auto decoded = decode_segment(kAddress, type, *stored);
    ASSERT_TRUE(decoded) << decoded.error().detail;
    EXPECT_TRUE(*decoded == segment);
    for (std::int64_t at = states.begin()->first; at <= paint.sequence() + 1; ++at)
      EXPECT_TRUE(tile_in_segment(type, *stored, at).value() ==
                  std::prev(states.upper_bound(at))->second)
          << at;
    EXPECT_TRUE(tile_in_segment(type, *stored, 0).value() == segment.before);
  }
}

TEST(TileSegment, what_it_cannot_represent_is_refused) {
  Paint paint(ValueType::u8, 4);
  TileSegment segment{TileData(ValueType::u8), {}};
  EXPECT_FALSE(encode_segment(segment)) << "no revision";
  for (int i = 0; i < TileSegment::kMaxRevisions; ++i) segment.entries.push_back(paint.next());
  EXPECT_TRUE(encode_segment(segment));
  segment.entries.push_back(paint.next());
  EXPECT_FALSE(encode_segment(segment)) << "too many revisions";
  segment.entries.resize(1);
  segment.entries[0].revision.written = {};
  EXPECT_FALSE(encode_segment(segment)) << "a difference outside the mask";
}

TEST(TileSegment, damaged_bytes_are_a_problem_and_never_a_crash) {
  Paint paint(ValueType::u16, 5);
  TileSegment segment{TileData(ValueType::u16), {}};
  for (int i = 0; i < 4; ++i) segment.entries.push_back(paint.next());
  const auto good = encode_segment(segment).value();
  EXPECT_FALSE(decode_segment(kAddress, ValueType::u8, good)) << "another width";
  EXPECT_FALSE(decode_tile(ValueType::u16, good)) << "another kind";
  EXPECT_FALSE(decode_segment(kAddress, ValueType::u16, encode_tile(segment.before)));
  for (std::size_t size = 0; size < good.size(); size += 1 + size / 7)
    EXPECT_FALSE(decode_segment(kAddress, ValueType::u16, std::span(good).first(size))) << size;
  std::mt19937 random(6);
  for (int i = 0; i < 300; ++i) {
    auto bad = good;
    bad[random() % bad.size()] ^= static_cast<std::uint8_t>(1u << (random() % 8));
    (void)decode_segment(kAddress, ValueType::u16, bad);
    (void)tile_in_segment(ValueType::u16, bad, 12);
  }
}

// The oracle of a merge: the merged revision and its parts give the same texels, whichever of the
// edits are in force.
TEST(TileSegment, merged_revisions_resolve_like_their_parts) {
  std::mt19937 random(7);
  for (int round = 0; round < 40; ++round) {
    Paint paint(ValueType::u8, 100 + static_cast<unsigned>(round));
    struct Edit {
      std::vector<TileRevision> parts;
      bool in_force, provisional;
    };
    std::vector<Edit> edits;
    for (int i = 0; i < 6; ++i) {
      Edit edit{{}, random() % 3 != 0, random() % 3 == 0};
      for (unsigned n = 1 + random() % 5; n > 0; --n) edit.parts.push_back(paint.next().revision);
      edits.push_back(std::move(edit));
    }
    TileMask texels;
    for (auto& word : texels.words) word = (std::uint64_t{random()} << 32) | random();
    TileResolver apart(paint.tile(), texels), together(paint.tile(), texels);
    for (auto edit = edits.rbegin(); edit != edits.rend(); ++edit) {
      for (auto part = edit->parts.rbegin(); part != edit->parts.rend(); ++part)
        apart.add({1, true, edit->in_force, edit->provisional, *part});
      TileRevision merged = edit->parts.front();
      for (std::size_t i = 1; i < edit->parts.size(); ++i) append(edit->parts[i], merged);
      EXPECT_TRUE(differs_only_where_written(merged));
      together.add({1, true, edit->in_force, edit->provisional, merged});
    }
    EXPECT_TRUE(apart.provisional() == together.provisional());
    EXPECT_TRUE(std::move(apart).finish() == std::move(together).finish());
  }
}

}  // namespace
}  // namespace strata
