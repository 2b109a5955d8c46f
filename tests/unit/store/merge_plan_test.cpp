#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <set>
#include <tuple>

#include "store/journal/merge_plan.h"

namespace strata::store {
namespace {

using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

const std::chrono::system_clock::time_point kBegin{1'000'000s};

Uuid stroke_id(int number) {
  Uuid id;
  id.bytes[0] = static_cast<std::uint8_t>(number);
  id.bytes[1] = static_cast<std::uint8_t>(number >> 8);
  return id;
}

// Batches and other edits, one every second.
class Journal {
 public:
  PlannedEdit& batch(int stroke, std::vector<std::int16_t> tiles, LayerId layer = 1) {
    PlannedEdit edit;
    edit.sequence = static_cast<std::int64_t>(edits_.size()) + 1;
    edit.layer = layer;
    edit.stroke = stroke_id(stroke);
    edit.user = "Ada";
    edit.time = kBegin + std::chrono::seconds(edit.sequence);
    edit.is_batch = true;
    edit.tiles = std::move(tiles);
    edits_.push_back(std::move(edit));
    return edits_.back();
  }
  PlannedEdit& fill(int stroke, std::vector<std::int16_t> tiles, LayerId layer = 1) {
    PlannedEdit& edit = batch(stroke, std::move(tiles), layer);
    edit.is_batch = false;
    return edit;
  }
  const std::vector<PlannedEdit>& edits() const { return edits_; }

  // The groups, as sequences.
  std::vector<std::vector<std::int64_t>> groups(MergeRules rules = ended()) const {
    std::vector<std::vector<std::int64_t>> found;
    for (const auto& group : plan_merges(edits_, rules).groups) {
      found.emplace_back();
      for (const std::size_t i : group) found.back().push_back(edits_[i].sequence);
    }
    return found;
  }
  static MergeRules ended() {
    MergeRules rules;
    rules.ended_before = kBegin + 1h;
    return rules;
  }

 private:
  std::vector<PlannedEdit> edits_;
};

TEST(MergePlan, a_stroke_becomes_one_edit) {
  Journal journal;
  for (const int stroke : {1, 1, 1, 2, 2}) journal.batch(stroke, {3, 4});
  journal.fill(3, {3});
  EXPECT_THAT(journal.groups(), ElementsAre(ElementsAre(1, 2, 3), ElementsAre(4, 5)));
  EXPECT_EQ(plan_merges(journal.edits(), Journal::ended()).through, 6);
  EXPECT_THAT(plan_merges({}, Journal::ended()).groups, IsEmpty());
}

TEST(MergePlan, the_end_of_another_edit_stays_exact_also_on_another_layer) {
  Journal journal;
  journal.batch(1, {1});
  journal.batch(1, {1});
  journal.fill(2, {9}, 7);
  journal.batch(1, {1});
  journal.batch(1, {1});
  EXPECT_THAT(journal.groups(), ElementsAre(ElementsAre(1, 2), ElementsAre(4, 5)));
}

TEST(MergePlan, strokes_at_the_same_time_are_merged_up_to_the_end_of_each) {
  Journal journal;
  for (const int stroke : {1, 2, 1, 2, 1, 2, 2})
    journal.batch(stroke, {static_cast<std::int16_t>(stroke)});
  // Stroke 1 ends with edit 5.
  EXPECT_THAT(journal.groups(),
              ElementsAre(ElementsAre(1, 3, 5), ElementsAre(2, 4), ElementsAre(6, 7)));
}

TEST(MergePlan, no_revision_moves_over_one_of_another_edit_in_the_same_tile) {
  Journal journal;
  journal.batch(1, {1, 2});
  journal.batch(1, {2, 3});
  journal.batch(2, {3});
  journal.batch(1, {5});  // writes elsewhere, but the group would move tile 3
  journal.batch(2, {5});
  journal.batch(1, {6});
  journal.batch(2, {8});
  // Tile 3 of stroke 2 can move, because nobody else wrote to it in the meantime.
  EXPECT_THAT(journal.groups(), ElementsAre(ElementsAre(1, 2), ElementsAre(3, 5)));
}

TEST(MergePlan, states_that_people_have_named_stay_exact) {
  Journal journal;
  for (int i = 0; i < 6; ++i) journal.batch(1, {1});
  MergeRules rules = Journal::ended();
  rules.named_states = {0, 2, 5, 6, 90};
  EXPECT_THAT(journal.groups(rules), ElementsAre(ElementsAre(1, 2), ElementsAre(3, 4, 5)));
}

TEST(MergePlan, only_batches_in_the_same_state_are_merged) {
  Journal journal;
  for (int i = 0; i < 6; ++i) journal.batch(1, {1}).traits = i < 2 ? "undone" : "";
  journal.batch(2, {1});
  journal.batch(2, {1}).user = "Ben";
  EXPECT_THAT(journal.groups(), ElementsAre(ElementsAre(1, 2), ElementsAre(3, 4, 5, 6)));
}

TEST(MergePlan, a_stroke_that_may_continue_waits_with_all_that_follows) {
  Journal journal;
  for (const int stroke : {1, 1, 2, 3, 3, 2}) journal.batch(stroke, {1});
  MergeRules rules = Journal::ended();
  rules.ended_before = kBegin + 5s;
  EXPECT_THAT(journal.groups(rules), ElementsAre(ElementsAre(1, 2)));
  EXPECT_EQ(plan_merges(journal.edits(), rules).through, 2);
  rules.ended_before = kBegin;
  EXPECT_EQ(plan_merges(journal.edits(), rules).through, 0);
}

TEST(MergePlan, a_stroke_longer_than_the_list_is_merged_in_parts) {
  Journal journal;
  for (int i = 0; i < 40; ++i) journal.batch(1, {1});
  MergeRules rules = Journal::ended();
  rules.is_cut = true;
  EXPECT_EQ(journal.groups(rules).front().size(), 40u);
  rules.max_revisions = 15;
  EXPECT_EQ(journal.groups(rules).size(), 3u);
  rules.max_revisions = 100;
  rules.max_span = 9;
  EXPECT_EQ(journal.groups(rules).size(), 4u);
}

TEST(MergePlan, the_path_of_a_merged_edit_is_limited) {
  Journal journal;
  for (int i = 0; i < 6; ++i) journal.batch(1, {1}).points = 100;
  MergeRules rules = Journal::ended();
  rules.max_points = 300;
  EXPECT_THAT(journal.groups(rules), ElementsAre(ElementsAre(1, 2, 3), ElementsAre(4, 5, 6)));
  rules.max_points = 299;
  EXPECT_EQ(journal.groups(rules).size(), 3u);
}

// The oracle: the batches of a group move to its last sequence. The texels at the end of each
// stroke and in each named state must contain the same batches, and no batch may move over another
// edit of its tile.
TEST(MergePlan, random_journals_keep_their_states) {
  std::mt19937 random(5);
  const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  std::size_t merged = 0;
  for (int round = 0; round < 60; ++round) {
    Journal journal;
    std::map<int, int> open;  // the stroke of each of three people
    int next = 10;
    for (int i = 0; i < 80; ++i) {
      const int person = below(3);
      if (!open.contains(person) || below(6) == 0) open[person] = next++;
      std::set<std::int16_t> tiles;
      for (int n = below(3); n >= 0; --n) tiles.insert(static_cast<std::int16_t>(below(12)));
      const LayerId layer(std::int64_t{1} + open[person] % 2);
      PlannedEdit& edit =
          below(15) == 0 ? journal.fill(next++, {}, layer) : journal.batch(open[person], {}, layer);
      edit.tiles.assign(tiles.begin(), tiles.end());
    }
    MergeRules rules = Journal::ended();
    if (round % 2 == 0) rules.ended_before = kBegin + 60s;
    rules.named_states = {static_cast<std::int64_t>(below(80))};
    const MergePlan plan = plan_merges(journal.edits(), rules);

    std::map<std::int64_t, std::int64_t> moved;  // by sequence
    for (const PlannedEdit& edit : journal.edits()) moved[edit.sequence] = edit.sequence;
    for (const auto& group : plan.groups) {
      for (const std::size_t i : group) {
        const PlannedEdit& edit = journal.edits()[i];
        ASSERT_LE(edit.sequence, plan.through);
        moved[edit.sequence] = journal.edits()[group.back()].sequence;
      }
      merged += group.size() - 1;
    }
    std::set<std::int64_t> exact(rules.named_states.begin(), rules.named_states.end());
    std::map<Uuid, std::int64_t> ends;
    for (const PlannedEdit& edit : journal.edits()) ends[edit.stroke] = edit.sequence;
    for (const auto& [stroke, end] : ends) exact.insert(end);
    for (const std::int64_t at : exact)
      for (const auto& [sequence, to] : moved)
        ASSERT_EQ(sequence <= at, to <= at) << "batch " << sequence << " in the state " << at;
    std::map<std::pair<LayerId, std::int16_t>, std::int64_t> newest;
    std::map<std::pair<LayerId, std::int16_t>, Uuid> writer;
    for (const PlannedEdit& edit : journal.edits())
      for (const std::int16_t tile : edit.tiles) {
        const std::pair place{edit.layer, tile};
        if (const auto before = newest.find(place); before != newest.end()) {
          if (writer[place] != edit.stroke)
            ASSERT_LT(before->second, moved[edit.sequence]);
          else
            ASSERT_LE(before->second, moved[edit.sequence]);
        }
        newest[place] = moved[edit.sequence];
        writer[place] = edit.stroke;
      }
  }
  EXPECT_GT(merged, 60u * 5);
}

}  // namespace
}  // namespace strata::store
