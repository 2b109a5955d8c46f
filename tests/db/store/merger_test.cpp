// The journal before and after its strokes are merged: the texels at the end of every stroke, undo
// and redo, the responses to edits that are sent again, and faults.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <functional>
#include <map>
#include <random>
#include <set>
#include <thread>
#include <utility>

#include "db/journal_painter.h"
#include "db/painted_journal.h"
#include "domain/layers/mask_texels.h"
#include "domain/layers/tile_difference.h"
#include "store/content/layers.h"
#include "store/journal/journal_merger.h"
#include "store/journal/journal_reads.h"
#include "store/nodes/nodes.h"
#include "store/pg/pg.h"

namespace strata::store {
namespace {

using namespace std::chrono_literals;
using test::content_of;
using test::Painted;
using test::save;
using Content = test::Painter::Content;
using Clock = std::chrono::system_clock;

class Merger : public ::testing::Test {
 protected:
  std::int64_t count(const std::string& what) {
    return PgConnection::connect(dsn_)->query_once("SELECT count(*) FROM " + what)->integer(0, 0);
  }
  void run(const std::string& sql) { ASSERT_TRUE(PgConnection::connect(dsn_)->script(sql)); }
  void name_state(std::int64_t sequence) {
    run("INSERT INTO snapshots (model_id, slug, name, content, user_name) VALUES (" +
        to_string(model_.id) + ", 's', 's', '{\"sequence\": " + std::to_string(sequence) +
        "}', 'Ada')");
  }
  // Saves a stroke of some batches. Each of them paints another square into the same two tiles.
  // `states` gets the texels of the layer before the stroke and after each batch.
  void save_stroke(const Layer& layer, int batches, std::vector<Content>* states = nullptr) {
    JournalWriter writer(*store_, {});
    Content& content = contents_[layer.id];
    if (states) states->push_back(content);
    const Uuid stroke = random_uuid();
    for (int n = 0; n < batches; ++n) {
      JournalEntry entry = test::Painter(layer, 1).entry(++sequence_);
      entry.stroke = stroke;
      entry.record = {{"op", "stroke"}, {"n", n}, {"path", {{n, 1}, {n + 1, 1}}}};
      for (const TileAddress tile : {TileAddress{0, 0}, TileAddress{1, 0}}) {
        const TileData before = content.contains(tile) ? content.at(tile) : TileData(layer.type);
        TileMask written;
        TileData after = before;
        for (int texel = 0; texel < 9; ++texel) {
          written.set(static_cast<int>(100 * sequence_) % kTexelsPerTile + texel);
          after.write(static_cast<int>(100 * sequence_) % kTexelsPerTile + texel,
                      1 + static_cast<std::uint32_t>(sequence_ % 99));
        }
        entry.revisions.push_back(
            {tile, encode_revision(make_revision(tile, before, after, written)), {}});
        content[tile] = std::move(after);
      }
      ASSERT_TRUE(save(writer, std::move(entry)));
      if (states) states->push_back(content);
    }
  }
  // Merges all strokes, because enough time has passed. A merger that has just started also packs
  // layers with few new revisions.
  void merge_all(Painted& painted) {
    JournalMerger merger(store_->journal());
    const auto done = painted.merge(merger, painted.time() + 1h);
    ASSERT_TRUE(done) << done.error().detail;
  }
  void check_all(Painted& painted, int every = 1) {
    painted.check_states(every);
    painted.check_ids();
    painted.check_rule();
    painted.check_provisional();
  }

  const std::string dsn_ = test::fresh_database();
  std::unique_ptr<Store> store_ = test::open_store(dsn_);
  Model model_ = test::make_model(*store_);
  JournalMerger merger_{store_->journal()};
  std::int64_t sequence_ = 0;
  std::map<LayerId, Content> contents_;  // of save_stroke
};

TEST_F(Merger, random_journals_give_the_same_texels_and_responses) {
  for (unsigned seed = 1; seed <= 2; ++seed) {
    const Model model = test::make_model(*store_, "pot " + std::to_string(seed));
    Painted painted(*store_, model.id, seed);
    for (int part = 0; part < 4; ++part) {
      painted.paint(110);
      painted.keep_near();
      if (part == 1) {
        painted.name_state();
        run("INSERT INTO snapshots (model_id, slug, name, content, user_name) VALUES (" +
            to_string(model.id) +
            ", 's', 's', '{\"sequence\": " + std::to_string(painted.sequence()) + "}', 'Ada')");
      }
      // While people paint, only strokes that have ended are merged.
      ASSERT_TRUE(painted.merge(merger_, painted.time() - 20s));
      check_all(painted, 4);
      if (HasFatalFailure()) return;
    }
    painted.end_all();
    merge_all(painted);
    check_all(painted);
    if (HasFatalFailure()) return;
    // Merging again changes nothing.
    const auto again = painted.merge(merger_, painted.time() + 1h);
    ASSERT_TRUE(again);
    EXPECT_EQ(again->edits + again->revisions, 0);
    // Undo and redo of merged and packed edits.
    for (int i = 0; i < 60; ++i) {
      const std::string user = std::vector<std::string>{"Ada", "Ben", "Cleo"}[i % 3];
      painted.turn(static_cast<std::size_t>(i / 3) % 2, user, i % 7 == 0);
      if (i % 10 == 0) painted.check_rule();
      if (HasFatalFailure()) return;
    }
    merge_all(painted);
    check_all(painted, 4);
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(count("edit_batches"), 50);
  EXPECT_GT(count("tile_segments"), 4);
}

TEST_F(Merger, a_long_journal_is_merged_in_several_windows) {
  Painted painted(*store_, model_.id, 11);
  painted.paint(420);
  painted.end_all();
  JournalMerger merger(store_->journal(), 130);
  int windows = 0;
  for (bool more = true; more; ++windows) {
    ASSERT_LT(windows, 40);
    const auto done = painted.merge(merger, painted.time() + 1h);
    ASSERT_TRUE(done) << done.error().detail;
    more = done->more;
    check_all(painted, 4);
    if (HasFatalFailure()) return;
  }
  EXPECT_GE(windows, 3);
  EXPECT_GT(count("edit_batches"), 50);
  check_all(painted);
}

TEST_F(Merger, a_stroke_becomes_one_edit_with_the_whole_path_and_the_sums) {
  test::Painter painter(test::make_layer(*store_, model_.id), 4);
  const Uuid stroke = random_uuid();
  std::vector<JournalEntry> entries;
  {
    JournalWriter writer(*store_, {});
    for (int n = 0; n < 4; ++n) {
      auto entry = painter.paint(n + 1, 2, 2);
      entry.stroke = stroke;
      entry.record = {{"op", "stroke"}, {"value", 7}, {"n", n}, {"path", {{n, 1}, {n + 1, 1}}}};
      if (n > 1) entry.record["widths"] = {1, 0.5};
      entry.answer = {{"sequence", n + 1}, {"texels_changed", 10 * n}, {"area_m2", 0.5}};
      entries.push_back(entry);
      ASSERT_TRUE(save(writer, std::move(entry)));
    }
  }
  const auto strokes = [&] {
    return store_->journal().timeline(model_.id, {{painter.layer().id}, {}, {}, 1})->edits;
  };
  EXPECT_EQ(strokes(), 1);
  const auto done = merger_.merge(model_.id, store_->journal().state(model_.id, {})->epoch,
                                  Clock::now() + 1h, [] { return true; });
  ASSERT_TRUE(done) << done.error().detail;
  EXPECT_EQ(done->edits, 3);
  EXPECT_EQ(strokes(), 1);
  const auto history = store_->journal().history(painter.layer().id, 10, 0).value();
  ASSERT_EQ(history.total, 1);
  const JournalRow& row = history.rows.at(0);
  EXPECT_EQ(row.sequence, 4);
  EXPECT_EQ(row.id, entries.back().id);
  EXPECT_LT(std::chrono::abs(row.time - entries.back().time), 1us);
  EXPECT_EQ(row.answer,
            (nlohmann::json{{"sequence", 4}, {"texels_changed", 60}, {"area_m2", 2.0}}));
  // Lists do not read the path.
  EXPECT_EQ(row.record, (nlohmann::json{{"op", "stroke"}, {"value", 7}, {"n", 3}}));
  const auto whole = store_->journal().state(model_.id, std::vector{row.id}).value().known;
  ASSERT_EQ(whole.size(), 1u);
  EXPECT_EQ(whole[0].record,
            (nlohmann::json{{"op", "stroke"},
                            {"value", 7},
                            {"n", 3},
                            {"path", {{0, 1}, {1, 1}, {2, 1}, {3, 1}, {3, 1}, {4, 1}}},
                            {"widths", {1, 1, 1, 0.5, 1, 0.5}}}));
  EXPECT_TRUE(content_of(store_->journal().load_tiles(painter.layer()).value()) ==
              painter.content());
  const auto steps = store_->journal().timeline_steps(model_.id, {painter.layer().id}, 9, true, 5);
  ASSERT_EQ(steps->steps.size(), 1u);
  EXPECT_EQ(steps->steps[0].first, 1);
  EXPECT_EQ(steps->steps[0].last, 4);
  EXPECT_EQ(steps->steps[0].texels, 60u);
}

// A person names a state in the middle of a stroke after the merger has read the journal.
TEST_F(Merger, a_state_that_is_named_during_a_merge_stays_exact) {
  std::vector<Content> states;
  const Layer layer = test::make_layer(*store_, model_.id);
  save_stroke(layer, 4, &states);
  const auto epoch = store_->journal().state(model_.id, {})->epoch;
  const auto merge = [&](const JournalMerger::Continue& go_on) {
    return merger_.merge(model_.id, epoch, Clock::now() + 1h, go_on);
  };
  bool is_named = false;
  const auto disturbed = merge([&] {
    if (!std::exchange(is_named, true)) name_state(2);
    return true;
  });
  ASSERT_TRUE(is_named);
  ASSERT_FALSE(disturbed);
  EXPECT_EQ(disturbed.error().code, ErrorCode::conflict);
  EXPECT_EQ(count("edits"), 4);
  // The next plan includes the state.
  ASSERT_TRUE(merge([] { return true; }));
  EXPECT_EQ(count("edits"), 2);
  EXPECT_TRUE(content_of(store_->journal().load_tiles(layer, 2).value()) == states.at(2));
  EXPECT_TRUE(content_of(store_->journal().load_tiles(layer).value()) == states.at(4));
}

TEST_F(Merger, a_damaged_revision_does_not_stop_the_merges_of_others) {
  const Layer damaged = test::make_layer(*store_, model_.id, ValueType::u8, "damaged"),
              other = test::make_layer(*store_, model_.id, ValueType::u8, "other");
  save_stroke(damaged, 3);
  save_stroke(other, 3);
  run("UPDATE tile_revisions SET difference = '\\x00' WHERE sequence = 2");
  const auto epoch = store_->journal().state(model_.id, {})->epoch;
  const auto done = merger_.merge(model_.id, epoch, Clock::now() + 1h, [] { return true; });
  ASSERT_TRUE(done) << done.error().detail;
  EXPECT_EQ(done->edits, 2);
  EXPECT_EQ(count("edits WHERE layer_id = " + to_string(damaged.id)), 3);
  EXPECT_EQ(count("edits WHERE layer_id = " + to_string(other.id)), 1);
  EXPECT_EQ(count("merged_journals WHERE sequence = 6"), 1) << "the window would be read again";
}

TEST_F(Merger, a_damaged_tile_does_not_stop_the_packing_of_others) {
  const Layer layer = test::make_layer(*store_, model_.id);
  for (int i = 0; i < JournalMerger::kRevisionsPerSegment; ++i) save_stroke(layer, 1);
  run("UPDATE tile_revisions SET difference = '\\x00' WHERE sequence = 5 AND tile_y = 0 AND tile_x = 0");
  const auto epoch = store_->journal().state(model_.id, {})->epoch;
  const auto done = merger_.merge(model_.id, epoch, Clock::now() + 1h, [] { return true; });
  ASSERT_TRUE(done) << done.error().detail;
  EXPECT_EQ(count("tile_segments"), 1);
  EXPECT_EQ(count("tile_segments WHERE tile_y = 0 AND tile_x = 0"), 0);
  EXPECT_EQ(count("tile_revisions WHERE tile_y = 0 AND tile_x = 0"),
            JournalMerger::kRevisionsPerSegment);
}

// Undo would not find these revisions.
TEST_F(Merger, revisions_of_an_edit_without_a_list_of_tiles_are_not_packed) {
  const Layer layer = test::make_layer(*store_, model_.id);
  for (int i = 0; i < JournalMerger::kRevisionsPerSegment; ++i) save_stroke(layer, 1);
  const auto epoch = store_->journal().state(model_.id, {})->epoch;
  const auto done = merger_.merge(model_.id, epoch, Clock::now() + 1h, [&] {
    if (count("merged_journals") > 0) run("UPDATE edits SET tiles = NULL WHERE sequence = 7");
    return true;
  });
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().code, ErrorCode::conflict);
  EXPECT_EQ(count("tile_segments"), 0);
  EXPECT_EQ(count("tile_revisions"), 2 * JournalMerger::kRevisionsPerSegment);
}

// The merge has locked the model while it waits for the layer, so painting would wait, too.
TEST_F(Merger, a_merge_gives_up_soon_if_another_change_has_locked_the_layer) {
  const Layer layer = test::make_layer(*store_, model_.id);
  save_stroke(layer, 3);
  const auto epoch = store_->journal().state(model_.id, {})->epoch;
  const auto merge = [&] {
    return merger_.merge(model_.id, epoch, Clock::now() + 1h, [] { return true; });
  };
  PgConnection other = PgConnection::connect(dsn_).value();
  {
    const Transaction change = Transaction::begin(other).value();
    ASSERT_TRUE(other.query("SELECT 1 FROM all_layers FOR UPDATE"));
    const auto refused = merge();
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::conflict) << refused.error().detail;
    EXPECT_EQ(count("edits"), 3);
  }
  ASSERT_TRUE(merge());
  EXPECT_EQ(count("edits"), 1);
}

TEST_F(Merger, a_review_finds_a_stroke_by_each_of_its_batches) {
  const Layer layer = test::make_layer(*store_, model_.id);
  test::Painter painter(layer, 4);
  JournalWriter writer(*store_, {});
  const Uuid stroke = random_uuid();
  for (int n = 0; n < 3; ++n) {
    auto entry = painter.paint(n + 1, 1, 1);
    entry.stroke = stroke;
    entry.review = Review::pending;
    entry.record = {{"op", "stroke"}, {"n", n}, {"path", {{n, 1}, {n + 1, 1}}}};
    entry.answer["area_m2"] = 0.5;
    ASSERT_TRUE(save(writer, std::move(entry)));
  }
  const auto before = store_->journal().review_queue(layer.id, {}, 9, 0).value();
  ASSERT_TRUE(merger_.merge(model_.id, store_->journal().state(model_.id, {})->epoch,
                            Clock::now() + 1h, [] { return true; }));
  ASSERT_EQ(count("edits"), 1);
  const auto after = store_->journal().review_queue(layer.id, {}, 9, 0).value();
  EXPECT_EQ(after.total, 1);
  EXPECT_EQ(after.strokes.at(0).sequence, before.strokes.at(0).sequence);
  EXPECT_EQ(after.strokes.at(0).texels, before.strokes.at(0).texels);
  EXPECT_EQ(after.strokes.at(0).begun, before.strokes.at(0).begun);
  for (const std::int64_t named : {1, 2, 3}) {
    const auto found = store_->journal().under_review(layer.id, Decision::accept, {{named}, {}});
    ASSERT_TRUE(found) << found.error().detail;
    ASSERT_EQ(found->edits.size(), 1u) << named;
    EXPECT_EQ(found->edits[0].sequence, 3);
    EXPECT_EQ(found->named, std::vector<std::int64_t>{3});
  }
  EXPECT_TRUE(store_->journal().under_review(layer.id, Decision::accept, {{4}, {}})->edits.empty());
}

TEST_F(Merger, a_server_that_lost_the_model_merges_nothing) {
  Painted painted(*store_, model_.id, 5);
  painted.paint(120);
  painted.end_all();
  const auto edits = count("edits"), revisions = count("tile_revisions");
  ASSERT_TRUE(store_->nodes().begin_epoch(model_.id));  // another server
  const auto done = painted.merge(merger_, painted.time() + 1h);
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().code, ErrorCode::moved);
  EXPECT_EQ(count("edits"), edits);
  EXPECT_EQ(count("tile_revisions"), revisions);
  EXPECT_EQ(count("merged_journals"), 0);
  painted.check_states();
  // The new owner merges.
  ASSERT_TRUE(
      merger_.merge(model_.id, painted.epoch() + 1, painted.time() + 1h, [] { return true; }));
  EXPECT_LT(count("edits"), edits);
  check_all(painted);
}

// The database ends the session of the merger in the middle of its transaction, at several rows.
TEST_F(Merger, a_merge_that_is_cut_off_changes_nothing) {
  Painted painted(*store_, model_.id, 6);
  painted.paint(400);
  painted.end_all();
  run("CREATE SEQUENCE merges; CREATE FUNCTION cut_off() RETURNS trigger LANGUAGE plpgsql AS $$ BEGIN "
      "IF nextval('merges') % 7 = 0 THEN PERFORM pg_terminate_backend(pg_backend_pid()); END IF; "
      "RETURN NULL; END $$; "
      "CREATE TRIGGER cut_off AFTER INSERT ON edit_batches FOR EACH STATEMENT EXECUTE FUNCTION cut_off(); "
      "CREATE TRIGGER cut_off AFTER INSERT ON tile_segments FOR EACH STATEMENT EXECUTE FUNCTION cut_off(); "
      "CREATE TRIGGER cut_off AFTER INSERT OR UPDATE ON merged_journals FOR EACH STATEMENT EXECUTE FUNCTION cut_off()");
  int failures = 0;
  for (int i = 0; i < 100; ++i) {
    const auto done = painted.merge(merger_, painted.time() + 1h);
    painted.check_ids();
    if (i % 5 == 0) painted.check_states(4);
    if (HasFatalFailure()) return;
    if (done && done->edits + done->revisions == 0) break;
    if (done) continue;
    ++failures;
    painted.paint(5);  // without new edits, packing is not tried again
    painted.end_all();
  }
  EXPECT_GT(failures, 2);
  EXPECT_GT(count("edit_batches"), 0);
  EXPECT_GT(count("tile_segments"), 0);
  check_all(painted);
  painted.paint(40);
  check_all(painted, 4);
}

// A room reads the edits of a stroke, computes an undo or redo of them and saves it. The merger may
// replace these edits after each of these steps.
TEST_F(Merger, an_undo_is_complete_if_its_edits_are_merged_in_the_meantime) {
  using enum Painted::TurnStep;
  unsigned seed = 20;
  for (const auto when : {has_edits, has_tiles, is_computed}) {
    const Model model = test::make_model(*store_, "pot " + std::to_string(seed));
    Painted painted(*store_, model.id, ++seed);
    std::int64_t merged = 0;
    painted.in_turn = [&](Painted::TurnStep step) {
      if (step != when) return;
      const auto done = painted.merge(merger_, painted.time() + 1h);
      ASSERT_TRUE(done) << done.error().detail;
      merged += done->edits;
    };
    for (int i = 0; i < 16; ++i) {
      painted.paint(15);
      painted.end_all();
      painted.turn(i % 2, std::vector<std::string>{"Ada", "Ben", "Cleo"}[i % 3], i % 4 == 3);
      if (HasFatalFailure()) return;
    }
    EXPECT_GT(merged, 0);
    check_all(painted);
    if (HasFatalFailure()) return;
  }
}

// The merger runs on its own thread all the time, also while another server claims the model.
TEST_F(Merger, people_paint_while_the_journal_is_merged) {
  Painted painted(*store_, model_.id, 9);
  std::atomic<std::int64_t> epoch = painted.epoch();
  std::atomic<bool> ends = false;
  std::atomic<int> merges = 0, deposed = 0;
  std::vector<std::string> problems;
  std::thread merging([&] {
    while (!ends) {
      const auto done = merger_.merge(model_.id, epoch, painted.time_of_saved() - 20s,
                                      [&] { return !ends.load(); });
      if (done)
        merges += done->edits > 0 ? 1 : 0;
      else if (done.error().code == ErrorCode::moved)
        ++deposed;
      else if (done.error().code != ErrorCode::conflict)  // of an undo at the same time
        problems.push_back(done.error().detail);
    }
  });
  // Paints until the condition is true. The limit ends a test whose merger does nothing.
  const auto paint_until = [&](const auto& condition) {
    for (int i = 0; i < 100 && !condition() && !HasFatalFailure(); ++i) painted.paint(20);
  };
  paint_until([&] { return merges >= 3; });
  painted.check_states(8);
  painted.claim_again();
  paint_until([&] { return deposed > 0; });
  const int of_first_claim = merges;
  epoch = painted.epoch();
  paint_until([&] { return merges >= of_first_claim + 3; });
  ends = true;
  merging.join();
  EXPECT_THAT(problems, ::testing::IsEmpty());
  EXPECT_GT(deposed, 0);
  EXPECT_GE(merges, of_first_claim + 3);
  painted.end_all();
  check_all(painted, 3);
  merge_all(painted);
  check_all(painted, 3);
}

TEST_F(Merger, it_stops_between_two_transactions) {
  Painted painted(*store_, model_.id, 7);
  painted.paint(150);
  painted.end_all();
  const auto edits = count("edits");
  int steps = 0;
  ASSERT_TRUE(
      merger_.merge(model_.id, painted.epoch(), painted.time() + 1h, [&] { return ++steps <= 2; }));
  EXPECT_LT(count("edits"), edits);
  EXPECT_EQ(count("merged_journals"), 0);
  check_all(painted);
  merge_all(painted);
  EXPECT_EQ(count("merged_journals"), 1);
  check_all(painted);
}

TEST_F(Merger, widening_and_erasing_a_layer_include_its_segments) {
  Painted painted(*store_, model_.id, 8);
  painted.paint(400);
  painted.end_all();
  merge_all(painted);
  const Layer layer = store_->layers().find(model_.id, "one", Role::owner).value();
  ASSERT_GT(count("tile_segments WHERE layer_id = " + to_string(layer.id)), 0);
  const auto narrow = store_->journal().load_tiles(layer, painted.sequence() / 2).value();
  const Layer wide = store_->layers().widen(layer, ValueType::u16).value();
  const auto widened_tiles = store_->journal().load_tiles(wide, painted.sequence() / 2).value();
  ASSERT_EQ(widened_tiles.tiles.size(), narrow.tiles.size());
  for (const auto& [address, tile] : narrow.tiles)
    EXPECT_TRUE(*widened_tiles.tiles.at(address) == widened(*tile, ValueType::u16));
  ASSERT_TRUE(store_->layers().remove(layer.id));
  for (const char* table : {"tile_segments", "edit_batches", "tile_revisions", "edits"})
    EXPECT_EQ(count(std::string(table) + " WHERE layer_id = " + to_string(layer.id)), 0) << table;
}

TEST_F(Merger, it_waits_for_nodes_of_other_versions_and_marks_the_database) {
  const auto readable_from = [&] {
    return PgConnection::connect(dsn_)
        ->query("SELECT readable_from IS NULL FROM schema_migrations WHERE version = '000047'")
        ->boolean(0, 0);
  };
  const auto may_merge = [&](std::chrono::milliseconds after_mark) {
    return merger_.may_merge("0.0.2", after_mark).value();
  };
  EXPECT_FALSE(readable_from());
  const Uuid other = random_uuid();
  ASSERT_TRUE(store_->nodes().join({other, "http://127.0.0.1:1", "0.0.1", ""}));
  EXPECT_FALSE(may_merge(0ms)) << "an older node could not read the result";
  EXPECT_FALSE(readable_from());
  // A paused node renews its lease when it continues, and does not check the database again.
  run("UPDATE nodes SET lease_until = clock_timestamp() - interval '50 minutes'");
  EXPECT_FALSE(may_merge(0ms));
  EXPECT_FALSE(readable_from());
  ASSERT_TRUE(store_->nodes().leave(other));
  EXPECT_FALSE(may_merge(1h)) << "a node that has just started may join yet";
  EXPECT_TRUE(readable_from());
  // Another server, or the same one after a restart, waits for the same mark.
  JournalMerger another(store_->journal());
  EXPECT_FALSE(another.may_merge("0.0.2", 1h).value());
  run("UPDATE schema_migrations SET unreadable_since = unreadable_since - interval '61 minutes'");
  EXPECT_TRUE(another.may_merge("0.0.2", 1h).value());
  EXPECT_TRUE(may_merge(0ms));
}

TEST_F(Merger, nodes_that_ended_long_ago_do_not_delay_merges) {
  ASSERT_TRUE(store_->nodes().join({random_uuid(), "http://127.0.0.1:1", "0.0.1", ""}));
  run("UPDATE nodes SET lease_until = clock_timestamp() - interval '61 minutes'");
  EXPECT_TRUE(merger_.may_merge("0.0.2", 0ms).value());
}

}  // namespace
}  // namespace strata::store
