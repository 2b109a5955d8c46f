#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "domain/layers/checkpoint.h"
#include "domain/layers/mask_texels.h"

namespace strata {
namespace {

// Random revisions of a tile. Some of their edits are not in force, and their texels are not
// restored, as if an undo after the revisions had done that.
class Past {
 public:
  explicit Past(unsigned seed) : random_(seed) { now_.write(5, 3); }

  void add(int count) {
    for (int i = 0; i < count; ++i) {
      TileMask written;
      TileData after = now_;
      for (int n = 0; n < 200; ++n) {
        const int texel = static_cast<int>(random_() % 600);
        written.set(texel);
        if (random_() % 5 == 0)
          after.clear(texel);
        else
          after.write(texel, random_() % 7);
      }
      const bool writer = random_() % 4 != 0;
      revisions.push_back(
          {i + 1, writer, random_() % 4 != 0, false, make_revision({1, 2}, now_, after, written)});
      now_ = after;
    }
  }
  std::vector<PastRevision> revisions;

  // Returns the tile after an edit that wrote all texels has been undone.
  TileData undone(const std::vector<PastRevision>& past) const {
    TileMask all;
    all.words.fill(~std::uint64_t{0});
    TileResolver resolver(now_, all);
    for (auto each = past.rbegin(); each != past.rend(); ++each) resolver.add(*each);
    return std::move(resolver).finish();
  }

 private:
  std::mt19937 random_;
  TileData now_{ValueType::u16};
};

std::vector<PastRevision> parts(const Checkpoint& checkpoint) {
  std::vector<PastRevision> parts;
  if (checkpoint.written) parts.push_back({1, true, true, false, *checkpoint.written});
  if (checkpoint.rest) parts.push_back({2, true, false, false, *checkpoint.rest});
  return parts;
}

TEST(Checkpoint, an_undo_finds_the_same_texels_below_it) {
  for (unsigned seed = 1; seed <= 8; ++seed) {
    Past past(seed);
    past.add(12);
    for (int joined = 1; joined <= 12; joined += 3) {
      const std::span<const PastRevision> all(past.revisions);
      const auto group = all.subspan(12 - static_cast<std::size_t>(joined));
      const Checkpoint checkpoint = join_revisions(group);
      EXPECT_TRUE(is_equivalent(group, checkpoint));
      std::vector<PastRevision> thinned(all.begin(), all.end() - joined);
      for (auto& part : parts(checkpoint)) thinned.push_back(std::move(part));
      EXPECT_EQ(past.undone(thinned), past.undone(past.revisions)) << seed << " " << joined;
    }
  }
}

TEST(Checkpoint, its_parts_differ_only_where_they_are_written) {
  Past past(20);
  past.add(10);
  const Checkpoint checkpoint = join_revisions(past.revisions);
  ASSERT_TRUE(checkpoint.written && checkpoint.rest);
  EXPECT_TRUE(differs_only_where_written(*checkpoint.written));
  EXPECT_TRUE(differs_only_where_written(*checkpoint.rest));
}

TEST(Checkpoint, edits_in_force_need_one_revision_and_cancelled_edits_none) {
  Past past(21);
  past.add(6);
  for (auto& each : past.revisions) each.writer = each.in_force = true;
  EXPECT_FALSE(join_revisions(past.revisions).rest);
  EXPECT_TRUE(join_revisions(past.revisions).written);
  // An edit, and the undo of this edit.
  std::vector<PastRevision> cancelled(2, past.revisions.front());
  cancelled[0].in_force = false;
  cancelled[1].writer = false;
  const Checkpoint nothing = join_revisions(cancelled);
  EXPECT_FALSE(nothing.written || nothing.rest);
  EXPECT_TRUE(is_equivalent(cancelled, nothing));
}

TEST(Checkpoint, a_wrong_checkpoint_is_not_equivalent) {
  Past past(22);
  past.add(10);
  const Checkpoint right = join_revisions(past.revisions);
  ASSERT_TRUE(right.written && right.rest);
  Checkpoint wrong = right;
  wrong.rest.reset();
  EXPECT_FALSE(is_equivalent(past.revisions, wrong));
  wrong = right;
  int texel = -1;
  for_each_texel(wrong.written->written, [&](int each) { texel = each; });
  wrong.written->difference.values[static_cast<std::size_t>(texel) * 2] ^= 1;
  EXPECT_FALSE(is_equivalent(past.revisions, wrong));
  wrong = right;
  wrong.written->written.reset(texel);
  EXPECT_FALSE(is_equivalent(past.revisions, wrong));
}

}  // namespace
}  // namespace strata
