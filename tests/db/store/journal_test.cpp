#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>

#include "db/journal_painter.h"
#include "store/content/layers.h"
#include "store/journal/journal_reads.h"
#include "store/pg/pg.h"

namespace strata::store {
namespace {

using test::content_of;
using test::Painter;
using test::save;

class Journal : public ::testing::Test {
 protected:
  const std::string dsn_ = test::fresh_database();
  std::unique_ptr<Store> store_ = test::open_store(dsn_);
  Model model_ = test::make_model(*store_);
};

class JournalOfType : public Journal, public ::testing::WithParamInterface<ValueType> {};

TEST_P(JournalOfType, a_layer_reads_as_it_was_after_every_edit) {
  const Layer layer = test::make_layer(*store_, model_.id, GetParam());
  Painter painter(layer, 7);
  std::vector<Painter::Content> states{{}};
  {
    JournalWriter writer(*store_, {});
    int saved = 0;
    for (int i = 1; i <= 220; ++i) {
      ASSERT_TRUE(
          writer.submit(painter.paint(i, 1 + painter.random() % 3, 2), [&](Result<void> result) {
            EXPECT_TRUE(result) << result.error().detail;
            ++saved;
          }));
      states.push_back(painter.content());
    }
    writer.drain();
    EXPECT_EQ(saved, 220);
  }
  // 440 revisions of 4 tiles are enough for at least one key tile of every tile.
  EXPECT_GE(PgConnection::connect(dsn_)
                ->query("SELECT count(*) FROM tile_revisions WHERE key_tile IS NOT NULL")
                ->integer(0, 0),
            4);
  for (std::size_t at = 0; at < states.size(); at += 1) {
    const auto snapshot = store_->journal().load_tiles(layer, static_cast<std::int64_t>(at));
    ASSERT_TRUE(snapshot) << snapshot.error().detail;
    EXPECT_EQ(snapshot->sequence, static_cast<std::int64_t>(at));
    ASSERT_TRUE(content_of(*snapshot) == states[at]) << "at " << at;
  }
  const auto newest = store_->journal().load_tiles(layer).value();
  EXPECT_EQ(newest.sequence, 220);
  EXPECT_TRUE(content_of(newest) == states.back());
}
INSTANTIATE_TEST_SUITE_P(Types, JournalOfType,
                         ::testing::Values(ValueType::u8, ValueType::i16, ValueType::f32));

TEST_F(Journal, layers_of_a_model_share_its_sequence_and_keep_their_own_state) {
  Painter one(test::make_layer(*store_, model_.id, ValueType::u8, "one"), 1);
  Painter two(test::make_layer(*store_, model_.id, ValueType::u16, "two"), 2);
  JournalWriter writer(*store_, {});
  for (int i = 1; i <= 20; ++i) ASSERT_TRUE(save(writer, (i % 3 ? one : two).paint(i, 2, 4)));
  EXPECT_EQ(store_->journal().last_sequence(model_.id).value(), 20);
  EXPECT_EQ(store_->layers().find(model_.id, "one", Role::owner)->sequence, 20);
  EXPECT_EQ(store_->layers().find(model_.id, "two", Role::owner)->sequence, 18);
  EXPECT_TRUE(content_of(store_->journal().load_tiles(one.layer()).value()) == one.content());
  EXPECT_TRUE(content_of(store_->journal().load_tiles(two.layer()).value()) == two.content());
  EXPECT_EQ(store_->journal().load_tiles(two.layer())->sequence, 18);
  Layer gone = one.layer();
  gone.id = 999;
  EXPECT_EQ(store_->journal().load_tiles(gone).error().code, ErrorCode::not_found);
}

TEST_F(Journal, damaged_revisions_are_a_problem_and_not_a_crash) {
  Painter painter(test::make_layer(*store_, model_.id), 1);
  JournalWriter writer(*store_, {});
  ASSERT_TRUE(save(writer, painter.paint(1, 2, 4)));
  ASSERT_TRUE(PgConnection::connect(dsn_)->script(
      "UPDATE tile_revisions SET difference = '\\x0102030405'"));
  EXPECT_EQ(store_->journal().load_tiles(painter.layer()).error().code, ErrorCode::internal);
  const std::vector<std::int64_t> first{1};
  EXPECT_EQ(store_->journal().written_by(painter.layer(), first).error().code, ErrorCode::internal);
}

TEST_F(Journal, opening_a_layer_reads_nothing_older_than_the_last_whole_tiles) {
  Painter painter(test::make_layer(*store_, model_.id), 3, 8);
  JournalWriter writer(*store_, {});
  for (int i = 1; i <= 100; ++i) ASSERT_TRUE(save(writer, painter.paint(i, 1, 2)));
  // Damages older revisions, so only queries with at= fail.
  ASSERT_TRUE(PgConnection::connect(dsn_)->script(
      "UPDATE tile_revisions r SET difference = '\\x00' WHERE sequence < (SELECT max(sequence) FROM tile_revisions k "
      "WHERE k.tile_x = r.tile_x AND k.tile_y = r.tile_y AND k.key_tile IS NOT NULL)"));
  EXPECT_TRUE(content_of(store_->journal().load_tiles(painter.layer()).value()) ==
              painter.content());
  EXPECT_EQ(store_->journal().load_tiles(painter.layer(), 5).error().code, ErrorCode::internal);
}

TEST_F(Journal, deleting_the_layer_of_the_newest_edit_leaves_a_gap_and_the_journal_goes_on) {
  Painter remaining(test::make_layer(*store_, model_.id, ValueType::u8, "kept"), 1);
  Painter gone(test::make_layer(*store_, model_.id, ValueType::u8, "gone"), 2);
  {
    JournalWriter writer(*store_, {});
    ASSERT_TRUE(save(writer, remaining.paint(1, 2, 4)));
    ASSERT_TRUE(save(writer, gone.paint(2, 2, 4)));
    ASSERT_TRUE(store_->layers().remove(gone.layer().id));
    EXPECT_EQ(store_->journal().last_sequence(model_.id).value(), 2) << "a sequence is given once";
    EXPECT_FALSE(save(writer, remaining.entry(2)));
    ASSERT_TRUE(save(writer, remaining.paint(3, 2, 4)));
  }
  // The result is the same after a restart.
  store_ = test::open_store(dsn_);
  JournalWriter writer(*store_, {});
  ASSERT_TRUE(save(writer, remaining.paint(4, 2, 4)));
  EXPECT_EQ(store_->journal().last_sequence(model_.id).value(), 4);
  std::vector<std::int64_t> sequences;
  const auto history = store_->journal().history(remaining.layer().id, 10, 0).value();
  for (const auto& row : history.rows) sequences.push_back(row.sequence);
  EXPECT_EQ(sequences, (std::vector<std::int64_t>{4, 3, 1}));
  EXPECT_TRUE(content_of(store_->journal().load_tiles(remaining.layer()).value()) ==
              remaining.content());
  EXPECT_EQ(store_->journal().load_tiles(remaining.layer(), 2)->sequence, 1);
}

TEST_F(Journal, three_painted_layers_of_4096_load_in_well_under_a_second_and_a_half) {
  std::vector<Layer> layers;
  JournalWriter writer(*store_, {});
  std::int64_t sequence = 0;
  for (int n = 0; n < 3; ++n) {
    layers.push_back(
        test::make_layer(*store_, model_.id, n == 2 ? ValueType::f32 : ValueType::u8, "big"));
    Painter painter(layers.back(), 10 + n);
    auto fill = painter.entry(++sequence, "fill");
    for (std::uint16_t y = 0; y < 32; ++y)
      for (std::uint16_t x = 0; x < 32; ++x) {
        TileData after(layers.back().type);
        TileMask written;
        for (int texel = 0; texel < kTexelsPerTile; ++texel) {
          after.write(texel, 1 + (painter.random() % 97 == 0 ? 3u : 0u));
          written.set(texel);
        }
        fill.revisions.push_back(
            painter.revision({x, y}, TileData(layers.back().type), after, written));
      }
    ASSERT_TRUE(save(writer, std::move(fill)));
    for (int i = 0; i < 8; ++i) {
      // Paints everything with strokes as differences from empty tiles. The content is irrelevant
      // here.
      auto stroke = painter.entry(++sequence);
      const TileData before(layers.back().type);
      TileData after(layers.back().type);
      TileMask written;
      for (int texel = i * 1000; texel < i * 1000 + 3000; ++texel) {
        after.write(texel, 2);
        written.set(texel);
      }
      const auto revision = painter.revision({0, 0}, before, after, written);
      for (std::uint16_t y = 0; y < 32; ++y)
        for (std::uint16_t x = 0; x < 32; ++x)
          stroke.revisions.push_back({{x, y}, revision.difference, {}});
      ASSERT_TRUE(save(writer, std::move(stroke)));
    }
  }
  const auto start = std::chrono::steady_clock::now();
  for (const Layer& layer : layers)
    EXPECT_EQ(store_->journal().load_tiles(layer)->tiles.size(), 1024u);
  const auto elapsed_ms = std::chrono::duration_cast<std::chrono::milliseconds>(
                              std::chrono::steady_clock::now() - start)
                              .count();
  std::printf(
      "[ figure   ] 3 layers of 4096² (2 u8, 1 f32), 9 revisions of every tile: loaded in %lld ms\n",
      static_cast<long long>(elapsed_ms));
  RecordProperty("load_ms", static_cast<int>(elapsed_ms));
}

}  // namespace
}  // namespace strata::store
