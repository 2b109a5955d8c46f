#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "db/journal_painter.h"
#include "store/journal/journal_reads.h"

namespace strata::store {
namespace {

using test::Painter;
using test::save;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

class History : public ::testing::Test {
 protected:
  std::unique_ptr<Store> store_ = test::fresh_store();
  Model model_ = test::make_model(*store_);
  Layer layer_ = test::make_layer(*store_, model_.id);
  Painter painter_{layer_, 3};
  JournalWriter writer_{*store_, {}};
  std::int64_t sequence_ = 0;

  // Saves batches of one stroke and returns their sequences.
  std::vector<std::int64_t> stroke(const std::string& user, int batches = 1,
                                   const std::string& op = "stroke") {
    const Uuid id = random_uuid();
    std::vector<std::int64_t> sequences;
    for (int i = 0; i < batches; ++i) {
      auto entry = painter_.entry(++sequence_, op, user);
      entry.stroke = id;
      EXPECT_TRUE(save(writer_, entry));
      sequences.push_back(sequence_);
    }
    return sequences;
  }
  void undo(const std::string& user) {
    auto entry = painter_.entry(++sequence_, "undo", user);
    entry.disable = store_->journal().undoable(layer_.id, user).value();
    ASSERT_FALSE(entry.disable.empty());
    ASSERT_TRUE(save(writer_, entry));
  }
  void redo(const std::string& user) {
    auto entry = painter_.entry(++sequence_, "redo", user);
    entry.enable = store_->journal().redoable(layer_.id, user).value();
    ASSERT_FALSE(entry.enable.empty());
    ASSERT_TRUE(save(writer_, entry));
  }
  std::vector<std::int64_t> undoable(const std::string& user) {
    return store_->journal().undoable(layer_.id, user).value();
  }
  std::vector<std::int64_t> redoable(const std::string& user) {
    return store_->journal().redoable(layer_.id, user).value();
  }
};

TEST_F(History, undo_takes_the_whole_newest_stroke_of_its_author) {
  EXPECT_THAT(undoable("Ada"), IsEmpty());
  stroke("Ada", 3);
  stroke("Ada", 2);
  stroke("Ben", 1);
  EXPECT_THAT(undoable("Ada"), ElementsAre(4, 5));
  EXPECT_THAT(undoable("Ben"), ElementsAre(6));
  EXPECT_THAT(redoable("Ada"), IsEmpty());
}

TEST_F(History, several_undos_are_redone_in_opposite_order) {
  stroke("Ada", 2);          // 1 2
  stroke("Ada", 1, "fill");  // 3
  undo("Ada");               // 4
  EXPECT_THAT(undoable("Ada"), ElementsAre(1, 2));
  undo("Ada");  // 5
  EXPECT_THAT(undoable("Ada"), IsEmpty());
  EXPECT_THAT(redoable("Ada"), ElementsAre(1, 2));
  redo("Ada");  // 6
  EXPECT_THAT(undoable("Ada"), ElementsAre(1, 2));
  EXPECT_THAT(redoable("Ada"), ElementsAre(3));
  redo("Ada");  // 7
  EXPECT_THAT(redoable("Ada"), IsEmpty());
  EXPECT_THAT(undoable("Ada"), ElementsAre(3));
}

TEST_F(History, new_paint_ends_redo_for_its_author_only) {
  stroke("Ada");  // 1
  stroke("Ben");  // 2
  undo("Ada");    // 3
  undo("Ben");    // 4
  stroke("Ada");  // 5
  EXPECT_THAT(redoable("Ada"), IsEmpty());
  EXPECT_THAT(redoable("Ben"), ElementsAre(2));
  undo("Ada");  // 6 undoes 5
  EXPECT_THAT(redoable("Ada"), ElementsAre(5));
  redo("Ada");
  EXPECT_THAT(redoable("Ada"), IsEmpty());
  EXPECT_THAT(undoable("Ada"), ElementsAre(5));
}

TEST_F(History, undo_stays_on_its_layer_and_a_restore_counts_as_paint) {
  const Layer other = test::make_layer(*store_, model_.id, ValueType::u8, "other");
  stroke("Ada");
  stroke("Ada", 1, "restore");
  EXPECT_THAT(undoable("Ada"), ElementsAre(2));
  undo("Ada");
  EXPECT_THAT(undoable("Ada"), ElementsAre(1));
  EXPECT_THAT(store_->journal().undoable(other.id, "Ada").value(), IsEmpty());
}

TEST_F(History, a_step_has_the_sums_and_the_value_of_its_batches) {
  const Uuid id = random_uuid();
  for (int i = 1; i <= 3; ++i) {
    auto entry = painter_.entry(++sequence_, "stroke", "Ada");
    entry.stroke = id;
    entry.record = {{"op", "stroke"}, {"value", 7}, {"erase", false}, {"n", i}};
    entry.answer = {{"texels_changed", 10 * i}, {"area_m2", 0.5}};
    ASSERT_TRUE(save(writer_, entry));
  }
  auto erased = painter_.entry(++sequence_, "fill", "Ada");
  erased.record = {{"op", "fill"}, {"value", 0}, {"erase", true}};
  ASSERT_TRUE(save(writer_, erased));
  stroke("Ben");
  const auto steps = store_->journal().undo_steps(model_.id, "Ada", {{layer_.id}, {}, 9}).value();
  ASSERT_EQ(steps.done.size(), 2u);
  EXPECT_TRUE(steps.done[0].erases);
  EXPECT_FALSE(steps.done[0].value);
  const UndoStep& painted = steps.done[1];
  EXPECT_EQ(std::pair(painted.first, painted.last), std::pair(std::int64_t{1}, std::int64_t{3}));
  EXPECT_EQ(painted.value, 7);
  EXPECT_FALSE(painted.erases);
  EXPECT_EQ(painted.texels, 60u);
  EXPECT_DOUBLE_EQ(painted.area_m2, 1.5);
  EXPECT_FALSE(steps.more);
  const auto one = store_->journal().undo_steps(model_.id, "Ada", {{layer_.id}, {}, 1}).value();
  EXPECT_EQ(one.done.size(), 1u);
  EXPECT_TRUE(one.more);
  EXPECT_THAT(store_->journal().undo_steps(model_.id, "Ada", {{}, {}, 9})->done, IsEmpty());
}

// From the same state, repeated undos, or redos, must change the edits of the list in its order.
TEST_F(History, the_steps_are_those_that_undos_and_redos_take_in_this_order) {
  std::mt19937 random(11);
  const auto turn_all = [&](bool redoes) {
    std::vector<std::int64_t> lasts;
    for (;;) {
      const auto next = redoes ? redoable("Ada") : undoable("Ada");
      if (next.empty()) return lasts;
      lasts.push_back(next.back());
      redoes ? redo("Ada") : undo("Ada");
    }
  };
  const auto lasts_of = [](const std::vector<UndoStep>& steps) {
    std::vector<std::int64_t> lasts;
    for (const UndoStep& step : steps) lasts.push_back(step.last);
    return lasts;
  };
  for (int round = 0; round < 12; ++round) {
    for (int i = 0; i < 12; ++i) switch (random() % 4) {
        case 0: stroke("Ben"); break;
        case 1:
          if (!redoable("Ada").empty()) redo("Ada");
          break;
        case 2:
          if (!undoable("Ada").empty()) undo("Ada");
          break;
        default: stroke("Ada", 1 + static_cast<int>(random() % 3));
      }
    const auto steps =
        store_->journal().undo_steps(model_.id, "Ada", {{layer_.id}, {}, 200}).value();
    const bool redoes = round % 2 == 0;
    EXPECT_EQ(turn_all(redoes), lasts_of(redoes ? steps.undone : steps.done)) << "round " << round;
  }
}

TEST_F(History, an_undo_and_what_it_undoes_may_come_in_one_transaction) {
  auto first = painter_.entry(1);
  auto second = painter_.entry(2, "undo");
  second.disable = {1};
  auto third = painter_.entry(3, "redo");
  third.enable = {1};
  auto fourth = painter_.entry(4, "undo");
  fourth.disable = {1};
  for (auto& entry : {first, second, third, fourth})
    ASSERT_TRUE(writer_.submit(entry, [](auto result) { EXPECT_TRUE(result); }));
  writer_.drain();
  EXPECT_THAT(undoable("Ada"), IsEmpty());
  EXPECT_THAT(redoable("Ada"), ElementsAre(1));
}

TEST_F(History, written_tiles_are_the_union_of_the_edits_masks) {
  std::map<TileAddress, TileMask> expected;
  for (int i = 1; i <= 6; ++i) {
    const auto entry = painter_.paint(i, 3, 3);
    if (i == 2 || i == 5)
      for (const auto& revision : entry.revisions) {
        const auto decoded =
            decode_revision(revision.tile, layer_.type, revision.difference).value();
        for (int w = 0; w < kMaskWords; ++w)
          expected[revision.tile].words[w] |= decoded.written.words[w];
      }
    ASSERT_TRUE(save(writer_, entry));
  }
  const std::vector<std::int64_t> edits{2, 5};
  const auto written = store_->journal().written_by(layer_, edits).value();
  ASSERT_EQ(written.size(), expected.size());
  for (const auto& tile : written) EXPECT_TRUE(tile.written == expected.at(tile.tile));
  EXPECT_TRUE(store_->journal().written_by(layer_, {})->empty());
}

TEST_F(History, every_revision_of_a_tile_comes_newest_first_and_leads_back_to_nothing) {
  for (int i = 1; i <= 120; ++i) ASSERT_TRUE(save(writer_, painter_.paint(i, 2, 2)));
  sequence_ = 120;
  auto entry = painter_.entry(121, "undo");
  entry.disable = {119, 120};
  ASSERT_TRUE(save(writer_, entry));
  for (const TileAddress tile : {TileAddress{0, 0}, TileAddress{1, 0}}) {
    auto current =
        painter_.content().contains(tile) ? painter_.content().at(tile) : TileData(layer_.type);
    std::int64_t before = 1000;
    int begins = 0, revisions = 0;
    ASSERT_TRUE(store_->journal().tile_past(
        layer_, tile, [&] { ++begins; },
        [&](const PastRevision& past) {
          EXPECT_LT(past.sequence, before);
          before = past.sequence;
          EXPECT_TRUE(past.writer);
          EXPECT_EQ(past.in_force, past.sequence < 119);
          EXPECT_EQ(past.revision.address, tile);
          apply(past.revision, current);
          ++revisions;
          return true;
        }));
    EXPECT_EQ(begins, 1);
    EXPECT_GT(revisions, 32) << "several pages";
    EXPECT_TRUE(current == TileData(layer_.type));
    revisions = 0;
    ASSERT_TRUE(store_->journal().tile_past(
        layer_, tile, [] {}, [&](const PastRevision&) { return ++revisions < 3; }));
    EXPECT_EQ(revisions, 3) << "it ends when nothing more is needed";
  }
  EXPECT_TRUE(store_->journal().tile_past(
      layer_, {7, 7}, [] {},
      [](const PastRevision&) {
        ADD_FAILURE() << "the tile has no revision";
        return true;
      }));
}

TEST_F(History, pages_are_newest_first_and_rows_are_whole) {
  std::vector<JournalEntry> entries;
  for (int i = 1; i <= 5; ++i) {
    entries.push_back(painter_.paint(i, 1, 2));
    entries.back().record["note"] = "größer ☃";
    ASSERT_TRUE(save(writer_, entries.back()));
  }
  const auto page = store_->journal().history(layer_.id, 2, 1).value();
  EXPECT_EQ(page.total, 5);
  ASSERT_EQ(page.rows.size(), 2u);
  EXPECT_EQ(page.rows[0].sequence, 4);
  const std::vector<Uuid> ids{random_uuid(), entries[2].id};
  const auto state = store_->journal().state(model_.id, ids).value();
  EXPECT_EQ(state.last_sequence, 5);
  ASSERT_EQ(state.known.size(), 1u);
  const auto* found = &state.known[0];
  EXPECT_EQ(found->id, entries[2].id);
  EXPECT_EQ(found->sequence, 3);
  EXPECT_EQ(found->record, entries[2].record);
  EXPECT_EQ(found->answer, entries[2].answer);
  EXPECT_EQ(found->user, "Ada");
  EXPECT_EQ(found->op, "stroke");
  EXPECT_EQ(found->stroke, entries[2].stroke);
  EXPECT_TRUE(found->in_force);
  EXPECT_LT(std::chrono::abs(found->time - entries[2].time), std::chrono::microseconds(1));
  EXPECT_EQ(store_->journal().state(model_.id, {})->last_sequence, 5);
  EXPECT_EQ(store_->journal().state(ModelId(model_.id.number() + 1), ids).error().code,
            ErrorCode::not_found);
  EXPECT_EQ(store_->journal().history(999, 10, 0).error().code, ErrorCode::not_found);
  EXPECT_TRUE(store_->journal().history(layer_.id, 10, 100)->rows.empty());
}

}  // namespace
}  // namespace strata::store
