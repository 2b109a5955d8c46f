// Undo, compared with an oracle that keeps the list of edits of every texel.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <set>

#include "domain/layers/history.h"

namespace strata {
namespace {

struct OracleWrite {
  std::int64_t sequence;
  bool valid;
  std::uint32_t value;
};

// A layer of one tile with many edits, which are undone and redone in any order.
class OneTileLayer {
 public:
  void paint(const TileMask& written, bool erase, std::uint32_t value, bool provisional = false) {
    if (provisional) waiting_.insert(next_);
    TileData after = tile_;
    for (int i = 0; i < kTexelsPerTile; ++i)
      if (written.test(i)) {
        erase ? after.clear(i) : after.write(i, value);
        writes_[i].push_back({next_, !erase, value});
      }
    push(true, written, after);
  }

  // Undoes (`in_force` is false) or redoes a past edit.
  void flip(std::int64_t sequence, bool in_force) {
    TileMask written;
    for (auto& entry : newest_first_)
      if (entry.sequence == sequence) {
        entry.in_force = in_force;
        written = entry.revision.written;
      }
    undone_[sequence] = !in_force;
    TileResolver resolver(tile_, written);
    for (const auto& entry : newest_first_) resolver.add(entry);
    for (int i = 0; i < kTexelsPerTile; ++i)
      EXPECT_EQ(resolver.provisional().test(i), written.test(i) && waits(i));
    push(false, written, std::move(resolver).finish());
  }

  void expect_equals_oracle() const {
    for (int i = 0; i < kTexelsPerTile; ++i) {
      bool valid = false;
      std::uint32_t value = 0;
      if (auto writes = writes_.find(i); writes != writes_.end())
        for (const auto& write : writes->second) {
          auto undone = undone_.find(write.sequence);
          if (undone != undone_.end() && undone->second) continue;
          valid = write.valid;
          value = write.valid ? write.value : 0;
        }
      ASSERT_EQ(tile_.valid.test(i), valid) << "texel " << i;
      ASSERT_EQ(tile_.bits(i), value) << "texel " << i;
    }
  }
  // Returns whether the newest write in force of the texel waits for review.
  bool waits(int texel) const {
    bool found = false;
    if (auto writes = writes_.find(texel); writes != writes_.end())
      for (const auto& write : writes->second)
        if (!is_undone(write.sequence)) found = waiting_.contains(write.sequence);
    return found;
  }
  bool is_undone(std::int64_t sequence) const {
    return undone_.contains(sequence) && undone_.at(sequence);
  }
  std::int64_t next() const { return next_; }
  const TileData& tile() const { return tile_; }

 private:
  void push(bool writer, const TileMask& written, const TileData& after) {
    const bool provisional = waiting_.contains(next_);
    newest_first_.insert(newest_first_.begin(), {next_++, writer, true, provisional,
                                                 make_revision({}, tile_, after, written)});
    tile_ = after;
  }
  TileData tile_{ValueType::u8};
  std::int64_t next_ = 1;
  std::vector<PastRevision> newest_first_;
  std::map<int, std::vector<OracleWrite>> writes_;
  std::map<std::int64_t, bool> undone_;
  std::set<std::int64_t> waiting_;
};

TileMask square(int x0, int y0, int size) {
  TileMask mask;
  for (int y = y0; y < std::min(kTileSize, y0 + size); ++y)
    for (int x = x0; x < std::min(kTileSize, x0 + size); ++x) mask.set(y * kTileSize + x);
  return mask;
}

TEST(History, undo_leaves_what_another_painted_over_it) {
  OneTileLayer layer;
  layer.paint(square(0, 0, 10), false, 1);  // A
  layer.paint(square(5, 0, 10), false, 2);  // B covers half of A
  layer.flip(1, false);                     // undoes A
  EXPECT_FALSE(layer.tile().valid.test(0));
  EXPECT_EQ(layer.tile().bits(5), 2u);
  layer.expect_equals_oracle();
}

TEST(History, undoing_both_in_any_order_leaves_nothing) {
  for (bool first_then_second : {true, false}) {
    OneTileLayer layer;
    layer.paint(square(0, 0, 10), false, 1);
    layer.paint(square(5, 0, 10), false, 2);
    layer.flip(first_then_second ? 1 : 2, false);
    layer.flip(first_then_second ? 2 : 1, false);
    EXPECT_FALSE(layer.tile().valid.any());
  }
}

TEST(History, an_undone_eraser_brings_the_paint_back) {
  OneTileLayer layer;
  layer.paint(square(0, 0, 20), false, 7);
  layer.paint(square(10, 10, 20), true, 0);
  layer.flip(2, false);
  EXPECT_EQ(layer.tile().bits(10 * kTileSize + 10), 7u);
  layer.expect_equals_oracle();
}

TEST(History, random_edits_undos_and_redos_equal_the_oracle) {
  for (unsigned seed = 0; seed < 12; ++seed) {
    std::mt19937 random(seed);
    OneTileLayer layer;
    std::vector<std::int64_t> edits;
    for (int step = 0; step < 60; ++step) {
      if (edits.empty() || random() % 3) {
        edits.push_back(layer.next());
        layer.paint(square(static_cast<int>(random() % 120), static_cast<int>(random() % 120),
                           4 + static_cast<int>(random() % 60)),
                    random() % 4 == 0, 1 + random() % 255, random() % 2 == 0);
      } else {
        const auto sequence = edits[random() % edits.size()];
        layer.flip(sequence, layer.is_undone(sequence));
      }
    }
    layer.expect_equals_oracle();
  }
}

}  // namespace
}  // namespace strata
