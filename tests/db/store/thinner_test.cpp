// The journal before and after its old part is thinned: the states that stay, undo, redo and
// reviews, the responses to edits that are sent again, and faults.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <map>
#include <random>
#include <thread>
#include <vector>

#include "core/text/timestamp.h"
#include "db/journal_painter.h"
#include "db/painted_journal.h"
#include "domain/layers/revision.h"
#include "store/content/layers.h"
#include "store/content/named_parts.h"
#include "store/journal/journal_merger.h"
#include "store/journal/journal_reads.h"
#include "store/journal/journal_thinner.h"
#include "store/nodes/nodes.h"
#include "store/people/audit.h"
#include "store/pg/pg.h"
#include "store/tables/tables.h"

namespace strata::store {
namespace {

using namespace std::chrono_literals;
using test::content_of;
using test::Painted;
using test::save;
using Clock = std::chrono::system_clock;
using Days = std::chrono::days;

constexpr std::chrono::seconds kStep = 50min;  // from one edit to the next

std::int64_t day(Clock::time_point time) {
  return std::chrono::floor<Days>(time).time_since_epoch().count();
}
std::int64_t week(Clock::time_point time) { return (day(time) + 3) / 7; }

class Thinner : public ::testing::Test {
 protected:
  std::int64_t count(const std::string& what) {
    return PgConnection::connect(dsn_)->query_once("SELECT count(*) FROM " + what)->integer(0, 0);
  }
  void run(const std::string& sql) { ASSERT_TRUE(PgConnection::connect(dsn_)->script(sql)); }
  void name_state(ModelId model, std::int64_t sequence) {
    run("INSERT INTO snapshots (model_id, slug, name, content, user_name) VALUES (" +
        to_string(model) + ", 's', 's', '{\"sequence\": " + std::to_string(sequence) +
        "}', 'Ada')");
  }
  Painted painted(ModelId model, unsigned seed) {
    return Painted(*store_, model, seed, Clock::now() - Days(150), kStep);
  }
  Result<JournalThinner::Done> thin(ModelId model, Clock::time_point before,
                                    Period keep = Period::day) {
    return JournalThinner(store_->journal()).thin(model, {before, keep}, [] { return true; });
  }
  void merge(Painted& painted) {
    JournalMerger merger(store_->journal());
    const auto done = painted.merge(merger, painted.time() + 1h);
    ASSERT_TRUE(done) << done.error().detail;
  }
  void check(Painted& painted, std::int64_t through, int every = 1) {
    painted.check_thinned(through, day, every);
    painted.check_ids();
    painted.check_rule();
    painted.check_provisional();
  }

  // Saves edits of one tile by Ada, one every six hours, the first `age` ago.
  void save_edits(const Layer& layer, int edits, Days age) {
    JournalWriter writer(*store_, {});
    test::Painter painter(layer, 7);
    for (int i = 1; i <= edits; ++i) {
      auto entry = painter.paint(i, 1, 1);
      entry.time = today_ - age + i * 6h - 1min;
      entry.answer = {{"sequence", i}, {"texels_changed", 2 * i}, {"area_m2", 0.5}};
      ids_.push_back(entry.id);
      ASSERT_TRUE(save(writer, std::move(entry)));
      states_.push_back(painter.content());
    }
  }

  // Runs SQL in the transaction of the thinner, before it locks the model.
  void run_between(const std::string& sql) {
    run("CREATE FUNCTION change_rows() RETURNS trigger LANGUAGE plpgsql AS $$ BEGIN " + sql +
        "; RETURN NULL; END $$; CREATE TRIGGER change_rows AFTER DELETE ON tile_revisions "
        "FOR EACH STATEMENT EXECUTE FUNCTION change_rows()");
  }
  // All rows that the thinner can change.
  std::string all_rows() {
    auto connection = PgConnection::connect(dsn_);
    return connection
        ->query_once(
            "SELECT concat((SELECT string_agg(e::text, ';' ORDER BY sequence) FROM edits e), "
            "(SELECT string_agg(b::text, ';' ORDER BY id) FROM edit_batches b), "
            "(SELECT string_agg(r::text, ';' ORDER BY sequence) FROM tile_revisions r), "
            "(SELECT string_agg(t::text, ';') FROM thinned_layers t), "
            "(SELECT string_agg(l::text, ';' ORDER BY id) FROM all_layers l), "
            "(SELECT string_agg(m::text, ';' ORDER BY id) FROM all_models m))")
        ->text(0, 0);
  }

  const Clock::time_point today_ = std::chrono::floor<Days>(Clock::now());
  const std::string dsn_ = test::fresh_database();
  std::unique_ptr<Store> store_ = test::open_store(dsn_);
  Model model_ = test::make_model(*store_);
  std::vector<Uuid> ids_;                           // of save_edits
  std::vector<test::Painter::Content> states_{{}};  // of save_edits, by sequence
};

TEST_F(Thinner, kept_states_undo_and_responses_of_random_journals_stay_exact) {
  for (const bool merges : {false, true}) {
    const unsigned seed = merges ? 3 : 1;
    const Model model = test::make_model(*store_, "pot " + std::to_string(seed));
    Painted painted = this->painted(model.id, seed);
    painted.paint(130);
    painted.keep_near();
    painted.name_state();
    name_state(model.id, painted.sequence());
    painted.paint(150);
    painted.keep_near();
    painted.paint(60);
    painted.end_all();
    if (merges) merge(painted);  // also packs the revisions into segments
    const std::int64_t through = painted.sequence() - 60;
    const auto edits = count("edits");
    const auto done = thin(model.id, painted.time_of(through) + 1s);
    ASSERT_TRUE(done) << done.error().detail;
    EXPECT_GT(done->removed, 0);
    EXPECT_EQ(done->skipped, 0);
    EXPECT_EQ(count("edits"), edits - done->removed);
    check(painted, through);
    if (HasFatalFailure()) return;
    // Thinning again changes nothing.
    EXPECT_EQ(thin(model.id, painted.time_of(through) + 1s)->removed, 0);
    // Undo and redo go back to the checkpoints.
    for (int i = 0; i < 60; ++i) {
      const std::string user = std::vector<std::string>{"Ada", "Ben", "Cleo"}[i % 3];
      painted.turn(static_cast<std::size_t>(i / 3) % 2, user, i % 7 == 0);
      if (i % 10 == 0) painted.check_rule();
      if (HasFatalFailure()) return;
    }
    painted.paint(60);
    painted.end_all();
    if (merges) merge(painted);
    check(painted, through, 3);
    if (HasFatalFailure()) return;
    // Longer periods, and a later limit. The checkpoints become part of others.
    const std::int64_t later = painted.sequence() - 30;
    ASSERT_TRUE(thin(model.id, painted.time_of(later) + 1s, Period::week));
    painted.check_thinned(later, week);
    painted.check_ids();
    painted.check_rule();
    painted.check_provisional();
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(count("edits WHERE op = 'checkpoint'"), 20);
  EXPECT_GT(count("tile_segments"), 4);
}

TEST_F(Thinner, a_journal_is_thinned_in_several_windows) {
  Painted painted = this->painted(model_.id, 5);
  painted.paint(300);
  painted.end_all();
  merge(painted);
  JournalThinner thinner(store_->journal(), 37);
  const std::int64_t through = painted.sequence() - 40;
  const auto done =
      thinner.thin(model_.id, {painted.time_of(through) + 1s, Period::week}, [] { return true; });
  ASSERT_TRUE(done) << done.error().detail;
  EXPECT_GT(done->removed, 0);
  painted.check_thinned(through, week);
  EXPECT_EQ(thin(model_.id, painted.time_of(through) + 1s, Period::week)->removed, 0);
}

// The database ends the session of the thinner in the middle of its transactions.
TEST_F(Thinner, work_that_is_cut_off_changes_nothing_and_can_be_continued) {
  Painted painted = this->painted(model_.id, 6);
  painted.paint(250);
  painted.end_all();
  merge(painted);
  run("CREATE SEQUENCE thinnings; CREATE FUNCTION cut_off() RETURNS trigger LANGUAGE plpgsql AS $$ BEGIN "
      "IF nextval('thinnings') % 5 = 0 THEN PERFORM pg_terminate_backend(pg_backend_pid()); END IF; "
      "RETURN NULL; END $$; "
      "CREATE TRIGGER cut_off AFTER INSERT OR UPDATE ON thinned_layers FOR EACH STATEMENT EXECUTE FUNCTION cut_off(); "
      "CREATE TRIGGER cut_off AFTER INSERT ON tile_segments FOR EACH STATEMENT EXECUTE FUNCTION cut_off()");
  const std::int64_t through = painted.sequence() - 20;
  int failures = 0;
  for (int i = 0; i < 100; ++i) {
    const auto done = thin(model_.id, painted.time_of(through) + 1s);
    if (i % 5 == 0) {
      painted.check_ids();
      painted.check_rule();
    }
    if (HasFatalFailure()) return;
    if (done) break;
    ++failures;
  }
  EXPECT_GT(failures, 2);
  EXPECT_EQ(thin(model_.id, painted.time_of(through) + 1s)->removed, 0);
  check(painted, through);
}

TEST_F(Thinner, it_stops_between_two_transactions) {
  Painted painted = this->painted(model_.id, 7);
  painted.paint(150);
  painted.end_all();
  const std::int64_t through = painted.sequence() - 20;
  const JournalThinner::Options options{painted.time_of(through) + 1s, Period::day};
  int steps = 0;
  JournalThinner thinner(store_->journal());
  ASSERT_TRUE(thinner.thin(model_.id, options, [&] { return ++steps <= 2; }));
  EXPECT_EQ(count("(SELECT generate_series(1, count) FROM thinned_layers) AS transactions"), 2);
  painted.check_rule();
  ASSERT_TRUE(thinner.thin(model_.id, options, [] { return true; }));
  check(painted, through);
}

TEST_F(Thinner, people_paint_while_the_journal_is_thinned_and_merged) {
  Painted painted = this->painted(model_.id, 9);
  // A decision about old edits is refused if they are thinned at the same time.
  painted.has_reviews = false;
  painted.paint(200);
  std::atomic<bool> ends = false;
  std::atomic<int> thinnings = 0;
  std::vector<std::string> problems;  // of the thinner
  std::thread thinning([&] {
    while (!ends) {
      const auto done = thin(model_.id, painted.time_of_saved() - 150 * kStep);
      if (!done)
        problems.push_back(done.error().detail);
      else if (done->removed > 0)
        ++thinnings;
    }
  });
  std::thread merging([&, epoch = painted.epoch()] {
    JournalMerger merger(store_->journal());
    while (!ends)
      (void)merger.merge(model_.id, epoch, painted.time_of_saved() - 20 * kStep,
                         [&] { return !ends.load(); });
  });
  // The limit ends a test whose thinner does nothing.
  for (int i = 0; i < 100 && thinnings < 5 && !HasFatalFailure(); ++i) painted.paint(20);
  ends = true;
  thinning.join();
  merging.join();
  EXPECT_THAT(problems, ::testing::IsEmpty());
  EXPECT_GE(thinnings, 5);
  painted.end_all();
  check(painted, painted.sequence() - 100, 3);
  merge(painted);
  const std::int64_t through = painted.sequence() - 10;
  ASSERT_TRUE(thin(model_.id, painted.time_of(through) + 1s));
  check(painted, through, 3);
}

TEST_F(Thinner, a_damaged_revision_does_not_stop_the_thinning_of_others) {
  const Layer layer = test::make_layer(*store_, model_.id);
  save_edits(layer, 12, Days(90));  // four edits on each of three days
  run("UPDATE tile_revisions SET difference = '\\x00' WHERE sequence = 6");
  const auto done = thin(model_.id, Clock::now() - Days(30));
  ASSERT_TRUE(done) << done.error().detail;
  EXPECT_EQ(done->removed, 6);
  EXPECT_EQ(done->skipped, 1);
  EXPECT_EQ(count("edits"), 6);
  EXPECT_EQ(count("edits WHERE sequence BETWEEN 5 AND 8 AND op = 'stroke'"), 4);
}

TEST_F(Thinner, a_checkpoint_names_the_authors_and_has_no_states_inside) {
  const Layer layer = test::make_layer(*store_, model_.id);
  save_edits(layer, 8, Days(90));
  run("UPDATE edits SET user_name = 'Ben' WHERE sequence = 3");
  const auto layers = std::vector{layer.id};
  const auto strokes = [&] {
    return store_->journal().timeline(model_.id, {layers, {}, {}, 1})->edits;
  };
  EXPECT_EQ(strokes(), 8);
  ASSERT_TRUE(thin(model_.id, Clock::now() - Days(30)));
  EXPECT_EQ(strokes(), 8) << "the timeline counts the strokes in checkpoints";
  const auto history = store_->journal().history(layer.id, 10, 0).value();
  ASSERT_EQ(history.total, 2);
  const JournalRow& row = history.rows.at(1);
  EXPECT_EQ(row.sequence, 4);
  EXPECT_EQ(row.op, "checkpoint");
  EXPECT_EQ(row.user, "");
  EXPECT_EQ(
      row.record.at("people"),
      (nlohmann::json{{{"user", "Ada"}, {"edits", 3}, {"texels_changed", 14}, {"area_m2", 1.5}},
                      {{"user", "Ben"}, {"edits", 1}, {"texels_changed", 6}, {"area_m2", 0.5}}}));
  for (std::int64_t at = 0; at <= 8; ++at) {
    const auto found = store_->journal().load_tiles(layer, at);
    EXPECT_EQ(found.has_value(), at % 4 == 0) << at;
    EXPECT_EQ(store_->journal().layer_sequences(model_.id, at).has_value(), at % 4 == 0) << at;
    if (found) {
      EXPECT_TRUE(content_of(*found) == states_.at(static_cast<std::size_t>(at))) << at;
    } else {
      EXPECT_EQ(found.error().code, ErrorCode::gone);
    }
  }
  const auto time_of = [&](std::int64_t sequence) {
    return utc_text(today_ - Days(90) + sequence * 6h);
  };
  EXPECT_EQ(store_->journal().sequence_at(model_.id, time_of(3)), 0);
  EXPECT_EQ(store_->journal().sequence_at(model_.id, time_of(7)), 4);
  const auto steps = store_->journal().timeline_steps(model_.id, layers, 9, true, 5).value();
  ASSERT_EQ(steps.steps.size(), 2u);
  EXPECT_EQ(steps.steps[0].first, 1);
  EXPECT_EQ(steps.steps[0].last, 4);
  EXPECT_EQ(steps.steps[0].user, "");
  EXPECT_EQ(steps.steps[1].user, "Ada");
  EXPECT_EQ(steps.steps[1].texels, 52u);
  // A snapshot cannot name a state that is gone.
  NamedPart snapshot;
  snapshot.model_id = model_.id;
  snapshot.name = "Lost";
  snapshot.content = {{"sequence", 6}};
  const auto made = store_->snapshots().create(snapshot);
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code, ErrorCode::gone);
  // Nobody can undo or redo a checkpoint.
  EXPECT_THAT(store_->journal().undoable(layer.id, "Ada").value(), ::testing::IsEmpty());
}

TEST_F(Thinner, responses_stay_for_a_year) {
  const Layer layer = test::make_layer(*store_, model_.id);
  save_edits(layer, 8, Days(364));
  ASSERT_TRUE(thin(model_.id, Clock::now() - Days(30)));
  EXPECT_EQ(store_->journal().state(model_.id, ids_)->known.size(), 8u);
  JournalThinner thinner(store_->journal());
  ASSERT_TRUE(thinner.forget_answers("", [] { return true; }));
  EXPECT_EQ(count("edit_batches"), 8);
  run("UPDATE edits SET time = time - interval '4 days'");
  ASSERT_TRUE(thinner.forget_answers("", [] { return true; }));
  EXPECT_EQ(count("edit_batches"), 0);
  EXPECT_EQ(thinner.forget_answers("unknown", [] { return true; }).error().code,
            ErrorCode::not_found);
}

TEST_F(Thinner, young_edits_are_never_thinned) {
  const Layer layer = test::make_layer(*store_, model_.id);
  save_edits(layer, 8, Days(90));
  JournalThinner thinner(store_->journal());
  for (const auto before : {Clock::now() - Days(29), Clock::now() + Days(365 * 170)}) {
    EXPECT_EQ(thinner.plan({before, Period::day}).error().code, ErrorCode::invalid);
    EXPECT_EQ(thin(model_.id, before).error().code, ErrorCode::invalid);
  }
  EXPECT_EQ(count("edits"), 8);
}

// Each change is made after the thinner has read the rows, and before it locks them.
TEST_F(Thinner, a_change_between_reading_and_replacing_is_noticed) {
  const Layer layer = test::make_layer(*store_, model_.id);
  save_edits(layer, 4, Days(90));
  ASSERT_EQ(thin(model_.id, today_ - Days(90) + 15h)->removed, 1);
  const std::string model = to_string(model_.id), before = all_rows();
  for (const std::string& change :
       {"INSERT INTO snapshots (model_id, slug, name, content, user_name) VALUES (" + model +
            ", 's', 's', '{\"sequence\": 3}', 'Ada')",
        std::string("UPDATE edits SET user_name = 'former-7' WHERE sequence = 3"),
        std::string(
            "UPDATE edits SET record = jsonb_set(record, '{people,0,user}', '\"former-7\"') "
            "WHERE op = 'checkpoint'"),
        std::string("UPDATE edits SET in_force = false, undone_by = 9 WHERE sequence = 4"),
        std::string("UPDATE edits SET review = 'pending' WHERE sequence = 4"),
        std::string("UPDATE thinned_layers SET count = count + 1"),
        std::string("UPDATE all_layers SET type = 'u16'"),
        std::string("UPDATE all_layers SET binned = now(), binned_by = 'Ada', binned_bytes = 0"),
        std::string("UPDATE all_models SET binned = now(), binned_by = 'Ada', binned_bytes = 0")}) {
    run_between(change);
    const auto done = thin(model_.id, Clock::now() - Days(30));
    ASSERT_TRUE(done) << done.error().detail;
    EXPECT_EQ(done->skipped, 1) << change;
    EXPECT_EQ(done->removed, 0) << change;
    EXPECT_EQ(all_rows(), before) << change;
    run("DROP TRIGGER change_rows ON tile_revisions; DROP FUNCTION change_rows()");
  }
  EXPECT_EQ(thin(model_.id, Clock::now() - Days(30))->removed, 2);
}

TEST_F(Thinner, an_error_names_the_nearest_states_of_a_checkpoint_of_two_edits) {
  const Layer layer = test::make_layer(*store_, model_.id);
  save_edits(layer, 8, Days(90));
  run("UPDATE edits SET in_force = false, undone_by = 8 WHERE sequence = 5");
  ASSERT_EQ(thin(model_.id, Clock::now() - Days(30))->removed, 5);
  EXPECT_EQ(count("edits WHERE sequence IN (7, 8) AND op = 'checkpoint'"), 2);
  for (const std::int64_t at : {5, 6, 7}) {
    const auto found = store_->journal().load_tiles(layer, at);
    ASSERT_FALSE(found) << at;
    EXPECT_EQ(found.error().code, ErrorCode::gone);
    EXPECT_THAT(found.error().detail, ::testing::HasSubstr("4 and 8")) << at;
  }
  const auto steps = store_->journal().timeline_steps(model_.id, {layer.id}, 9, true, 5).value();
  ASSERT_EQ(steps.steps.size(), 2u) << "the edit with the other changes is not a step";
  EXPECT_EQ(steps.steps[1].last, 8);
  EXPECT_EQ(steps.steps[1].user, "Ada");
}

// Checkpoints of two layers overlap. A state inside either of them is not available.
TEST_F(Thinner, the_timeline_leads_to_states_of_all_layers) {
  const Layer one = test::make_layer(*store_, model_.id, ValueType::u8, "one"),
              two = test::make_layer(*store_, model_.id, ValueType::u8, "two");
  save_edits(one, 4, Days(90));
  run("UPDATE edits SET layer_id = " + to_string(two.id) +
      " WHERE sequence IN (2, 4); UPDATE tile_revisions SET layer_id = " + to_string(two.id) +
      " WHERE sequence IN (2, 4)");
  ASSERT_EQ(thin(model_.id, Clock::now() - Days(30))->removed, 2);
  const std::vector layers{one.id, two.id};
  const auto timeline = store_->journal().timeline(model_.id, {layers, {}, {}, 2}).value();
  ASSERT_EQ(timeline.intervals.size(), 2u);
  EXPECT_EQ(timeline.intervals[0].last, 0) << "no newer state than the end of the interval";
  EXPECT_EQ(timeline.intervals[1].last, 4);
  const auto steps = store_->journal().timeline_steps(model_.id, layers, 9, true, 5).value().steps;
  ASSERT_EQ(steps.size(), 2u);
  for (const TimelineStep& step : steps) {
    EXPECT_EQ(step.last, 4);
    EXPECT_EQ(step.time, today_ - Days(90) + 24h - 1min);
  }
}

TEST_F(Thinner, records_have_no_time_within_a_checkpoint_of_another_layer) {
  const Layer one = test::make_layer(*store_, model_.id, ValueType::u8, "one"),
              two = test::make_layer(*store_, model_.id, ValueType::u8, "two");
  save_edits(two, 4, Days(90));
  run("UPDATE edits SET layer_id = " + to_string(one.id) +
      " WHERE sequence = 1; UPDATE tile_revisions SET layer_id = " + to_string(one.id) +
      " WHERE sequence = 1");
  Table table;
  table.project_id = model_.project_id;
  table.name = "Finds";
  const TableId id = store_->tables().create(table, {})->id;
  const auto when = [&](std::int64_t at) {
    return store_->tables().sequence_when(id, model_.id, at);
  };
  EXPECT_TRUE(when(2));
  ASSERT_EQ(thin(model_.id, Clock::now() - Days(30))->removed, 2);
  EXPECT_TRUE(store_->journal().load_tiles(one, 2)) << "the layer itself has this state";
  EXPECT_EQ(when(2).error().code, ErrorCode::gone);
  for (const std::int64_t at : {0, 1, 4}) EXPECT_TRUE(when(at)) << at;
}

TEST_F(Thinner, a_damaged_key_tile_is_noticed) {
  const Layer layer = test::make_layer(*store_, model_.id);
  save_edits(layer, 4, Days(90));
  const auto wrong = encode_tile(TileData(ValueType::u8));
  Params params;
  params.bytes(wrong);
  // The first key tile cannot be compared. The second one differs from it and the differences.
  ASSERT_TRUE(PgConnection::connect(dsn_)->query_once(
      "UPDATE tile_revisions SET key_tile = $1 WHERE sequence IN (2, 3)", params));
  const auto done = thin(model_.id, Clock::now() - Days(30));
  ASSERT_TRUE(done) << done.error().detail;
  EXPECT_EQ(done->skipped, 1);
  EXPECT_EQ(count("edits"), 4);
}

TEST_F(Thinner, large_groups_are_divided) {
  const Layer layer = test::make_layer(*store_, model_.id, ValueType::f32);
  JournalWriter writer(*store_, {});
  std::mt19937 random(1);
  TileMask all;
  all.words.fill(~std::uint64_t{0});
  std::map<TileAddress, TileData> content;
  // Two edits with noise are together larger than one transaction. The others are small.
  for (int sequence = 1; sequence <= 4; ++sequence) {
    JournalEntry entry = test::Painter(layer, 1).entry(sequence, "fill");
    entry.time = today_ - Days(90) + sequence * 1h;
    for (int i = 0; i < (sequence <= 2 ? 170 : 1); ++i) {
      const TileAddress tile{static_cast<std::uint16_t>(i % 16),
                             static_cast<std::uint16_t>(i / 16)};
      TileData& before = content.try_emplace(tile, ValueType::f32).first->second;
      TileData noise(ValueType::f32);
      for (int texel = 0; texel < kTexelsPerTile; ++texel)
        noise.write(texel, static_cast<std::uint32_t>(random()) & 0x3fffffffU);
      entry.revisions.push_back(
          {tile, encode_revision(make_revision(tile, before, noise, all)), {}});
      before = std::move(noise);
    }
    ASSERT_TRUE(save(writer, std::move(entry)));
  }
  const auto done = thin(model_.id, Clock::now() - Days(30));
  ASSERT_TRUE(done) << done.error().detail;
  EXPECT_EQ(done->skipped, 0);
  EXPECT_EQ(done->removed, 2);
  EXPECT_EQ(count("edits WHERE sequence = 1 AND op = 'fill'"), 1);
  EXPECT_EQ(count("edits WHERE sequence = 4 AND op = 'checkpoint'"), 1);
  EXPECT_TRUE(content_of(store_->journal().load_tiles(layer).value()) == content);
}

TEST_F(Thinner, the_origin_of_the_content_stays) {
  const Layer layer = test::make_layer(*store_, model_.id);
  save_edits(layer, 12, Days(90));
  run("UPDATE edits SET op = 'compute' WHERE sequence IN (5, 8); "
      "UPDATE edits SET op = 'import', record = '{\"op\": \"import\", \"recipe\": {}}' WHERE sequence = 2");
  ASSERT_TRUE(thin(model_.id, Clock::now() - Days(30)));
  EXPECT_EQ(count("edits WHERE op = 'import'"), 1);
  EXPECT_EQ(count("edits WHERE op = 'compute'"), 1);
  EXPECT_EQ(count("edits WHERE op = 'compute' AND sequence = 8"), 1);
}

TEST_F(Thinner, edits_whose_state_can_still_change_stay) {
  const Layer layer = test::make_layer(*store_, model_.id);
  save_edits(layer, 12, Days(90));
  // A newer undo, a newer decision, and an edit that waits for review.
  run("UPDATE edits SET in_force = false, undone_by = 11 WHERE sequence = 2; "
      "UPDATE edits SET review = 'accepted', reviewed_by = 12 WHERE sequence = 4; "
      "UPDATE edits SET review = 'pending' WHERE sequence = 6");
  const auto done = thin(model_.id, today_ - Days(88));
  ASSERT_TRUE(done) << done.error().detail;
  EXPECT_EQ(done->removed, 1) << "only 7 and 8 have no edit between them that stays";
  for (const int sequence : {1, 2, 3, 4, 5, 6, 9, 10, 11, 12})
    EXPECT_EQ(count("edits WHERE op = 'stroke' AND sequence = " + std::to_string(sequence)), 1)
        << sequence;
}

// A room reads the edits of an undo, and then they become part of a checkpoint.
TEST_F(Thinner, an_undo_of_edits_that_were_thinned_meanwhile_is_refused) {
  const Layer layer = test::make_layer(*store_, model_.id);
  save_edits(layer, 4, Days(90));
  const auto edits = store_->journal().undoable(layer.id, "Ada").value();
  ASSERT_EQ(edits, std::vector<std::int64_t>{4});
  ASSERT_TRUE(thin(model_.id, Clock::now() - Days(30)));
  for (const std::int64_t old : {3, 4}) {
    JournalWriter writer(*store_, {});
    auto entry = test::Painter(layer, 1).entry(5, "undo");
    entry.disable = {old};
    const auto undone = save(writer, std::move(entry));
    ASSERT_FALSE(undone);
    EXPECT_EQ(undone.error().code, ErrorCode::conflict) << undone.error().detail;
  }
  EXPECT_EQ(store_->journal().last_sequence(model_.id), 4);
  EXPECT_EQ(count("edits WHERE op = 'checkpoint' AND in_force"), 1);
}

TEST_F(Thinner, a_plan_counts_and_the_audit_log_names_the_model) {
  const Layer layer = test::make_layer(*store_, model_.id);
  test::make_model(*store_, "untouched");
  save_edits(layer, 8, Days(90));
  JournalThinner thinner(store_->journal());
  const JournalThinner::Options options{Clock::now() - Days(30), Period::day};
  const auto plans = thinner.plan(options).value();
  ASSERT_EQ(plans.size(), 1u);
  EXPECT_EQ(plans[0].model, model_.id);
  EXPECT_EQ(plans[0].edits, 8);
  EXPECT_EQ(plans[0].removed, 6);
  EXPECT_GT(plans[0].removed_bytes, 0u);
  EXPECT_LT(plans[0].removed_bytes, plans[0].bytes);
  EXPECT_EQ(count("edits"), 8);
  EXPECT_EQ(thinner.plan(options, model_.slug)->size(), 1u);
  EXPECT_EQ(thinner.plan(options, "untouched")->size(), 0u);
  EXPECT_EQ(thinner.plan(options, "unknown").error().code, ErrorCode::not_found);
  ASSERT_TRUE(thinner.note(options, plans[0]));
  const auto rows = store_->audit().rows({.action = "erased"}).value();
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].subject_kind, "history");
  EXPECT_EQ(rows[0].subject_id, model_.id.number());
  EXPECT_EQ(rows[0].details.at("edits"), 6);
}

TEST_F(Thinner, it_refuses_while_the_site_has_nodes_of_other_versions) {
  JournalThinner thinner(store_->journal());
  const Uuid other = random_uuid();
  ASSERT_TRUE(store_->nodes().join({other, "http://127.0.0.1:1", "0.0.1", ""}));
  EXPECT_EQ(thinner.may_thin("0.0.2", 0ms).error().code, ErrorCode::conflict);
  ASSERT_TRUE(store_->nodes().leave(other));
  EXPECT_FALSE(thinner.may_thin("0.0.2", 1h).value());
  EXPECT_TRUE(thinner.may_thin("0.0.2", 0ms).value());
}

}  // namespace
}  // namespace strata::store
