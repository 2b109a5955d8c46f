// Faults: the GPU's memory is full or its context is lost, the database is unreachable or has more
// edits than the room, or the room closes. After each fault, every edit that was confirmed as saved
// is in the journal, and the room and the GPU have the content of the journal.
#include <gmock/gmock.h>
#include <libpq-fe.h>

#include <chrono>
#include <thread>

#include "room/edit.h"
#include "room/edits.h"
#include "room/layers.h"
#include "room/listener.h"
#include "room/participants.h"
#include "room/pipeline/tile_changes.h"
#include "room/queries.h"
#include "room/rooms.h"
#include "store/content/layers.h"
#include "store/content/models.h"
#include "store/journal/journal_reads.h"
#include "store/journal/journal_writer.h"
#include "support/room_fixture.h"
#include "support/whole_picture.h"

namespace strata {
namespace {

using test::RoomTest;
using Answer = Result<room::EditAnswer>;

constexpr auto kLong = std::chrono::minutes(5);

// A listener that counts the notifications of a participant.
class Ears : public room::Listener {
 public:
  void edit_applied(const Edit&) override { count(applied_); }
  void edits_unsaved(const std::vector<Edit>&, const Error&) override {}
  void layer_changed(LayerChange, const Layer& layer) override {
    std::lock_guard lock(mutex_);
    layers_.push_back(layer.id);
    changed_.notify_all();
  }
  void model_changed(const Model&) override {}
  void surface_image_changed(LayerChange, const SurfaceImage&) override {}
  void model_deleted() override { count(deleted_); }
  void moved(const std::string&) override {}
  void database_reachable(bool) override {}
  void presence_changed() override { count(presence_); }
  void view_refused(std::uint32_t, const Error&) override {}

  void wait_for_applied(int expected) { wait(applied_, expected); }
  void wait_for_presence(int expected) { wait(presence_, expected); }
  void wait_for_layer(LayerId id) {
    std::unique_lock lock(mutex_);
    ASSERT_TRUE(
        changed_.wait_for(lock, kLong, [&] { return std::ranges::count(layers_, id) > 0; }));
  }
  std::vector<LayerId> layers() {
    std::lock_guard lock(mutex_);
    return layers_;
  }
  int deleted() {
    std::lock_guard lock(mutex_);
    return deleted_;
  }

 private:
  void count(int& what) {
    std::lock_guard lock(mutex_);
    ++what;
    changed_.notify_all();
  }
  void wait(const int& what, int expected) {
    std::unique_lock lock(mutex_);
    ASSERT_TRUE(changed_.wait_for(lock, kLong, [&] { return what >= expected; }));
  }
  std::mutex mutex_;
  std::condition_variable changed_;
  int applied_ = 0, deleted_ = 0, presence_ = 0;
  std::vector<LayerId> layers_;  // that changed
};

class Connection {
 public:
  explicit Connection(const std::string& dsn) : connection_(PQconnectdb(dsn.c_str()), &PQfinish) {}
  void execute(const char* sql) {
    std::unique_ptr<PGresult, decltype(&PQclear)> result(PQexec(connection_.get(), sql), &PQclear);
    ASSERT_EQ(PQresultStatus(result.get()), PGRES_COMMAND_OK) << PQerrorMessage(connection_.get());
  }

 private:
  std::unique_ptr<PGconn, decltype(&PQfinish)> connection_;
};

class RoomRecovery : public RoomTest {
 protected:
  void execute(const char* sql) { Connection(dsn_).execute(sql); }

  // Restarts with a GPU that has 20 MiB for one slice of pages of four bytes. This is enough for a
  // fully painted layer of 2048² and for the content that is shown and painted before the restart,
  // but not for a fully painted layer of 4096².
  void restart_with_little_gpu_memory(std::initializer_list<Layer> layers) {
    for (const Layer& layer : layers) {
      EXPECT_TRUE(send(stroke(layer, 5, {{320, 240}}, 20)));
    }
    EXPECT_TRUE(test::whole_picture(room()->pictures(), {}, camera({0.3, -1, 0.4})));
    restart(renderer_->gpu_bytes_used() + (9u << 20));
  }

  // Commits an edit without the room, like a commit whose result was lost.
  void commit_behind(const room::EditRequest& edit, const Layer& layer, std::int64_t sequence,
                     bool damaged) {
    store::JournalEntry entry;
    entry.model_id = model_.id;
    entry.layer_id = layer.id;
    entry.sequence = sequence;
    entry.epoch = store_->journal().state(model_.id, {})->epoch;
    entry.id = entry.stroke = edit.id;
    entry.user = edit.author.user;
    entry.op = "stroke";
    entry.record = edit.record;
    entry.answer = {{"sequence", sequence}, {"texels_changed", 1}, {"area_m2", 0.5}};
    entry.time = std::chrono::system_clock::now();
    const TileAddress address{3, 3};
    const auto tiles = store_->journal().load_tiles(layer)->tiles;
    const auto before = room::tile_or_empty(tiles, address, layer.type);
    TileData after = *before;
    TileMask written;
    for (int texel = 0; texel < 2000; ++texel) {
      written.set(texel);
      after.write(texel, 77);
    }
    entry.revisions.push_back(
        {address, encode_revision(make_revision(address, *before, after, written)), {}});
    if (damaged) entry.revisions[0].difference = {1, 2, 3};
    store::JournalWriter writer(*store_, {});
    std::promise<Result<void>> saved;
    ASSERT_TRUE(writer.submit(std::move(entry),
                              [&](Result<void> result) { saved.set_value(std::move(result)); }));
    const auto result = saved.get_future().get();
    ASSERT_TRUE(result) << result.error().detail;
  }
};

TEST(TileChanges, a_stroke_changes_what_it_wrote_whatever_the_gpu_holds_elsewhere) {
  TileData before(ValueType::u8), read_back(ValueType::u8);
  for (int texel = 0; texel < 100; ++texel) before.write(texel, 3);
  TileMask written;
  for (int texel : {5, 6, 200}) {
    written.set(texel);
    read_back.write(texel, 9);
  }
  const auto change =
      room::painted_change({1, 2}, std::make_shared<const TileData>(before), written, read_back);
  TileData expected = before;
  for (int texel : {5, 6, 200}) expected.write(texel, 9);
  EXPECT_TRUE(*change.after == expected);
  EXPECT_TRUE(*change.before == before);
}

// --- The GPU

TEST_F(RoomRecovery, layers_that_do_not_fit_the_gpu_together_are_painted_in_turn) {
  const Layer a = make_layer(ValueType::u32, 2048, "a"), b = make_layer(ValueType::u32, 2048, "b");
  restart_with_little_gpu_memory({a});
  for (std::uint32_t value = 1; value < 4; ++value)
    for (const Layer& layer : {a, b}) {
      ASSERT_TRUE(send(request(layer, room::FillEdit{false, value})));
      ASSERT_TRUE(send(stroke(layer, 10 + value, {{310, 250}}, 20)));
    }
  expect_room_equals_journal(a);
  expect_room_equals_journal(b);
  const auto both = test::whole_picture(room()->pictures(), {}, camera({0.3, -1, 0.4}));
  ASSERT_FALSE(both) << "two full layers in one picture";
  EXPECT_EQ(both.error().code, ErrorCode::out_of_memory);
  restart();
  expect_picture_of_journal();
}

TEST_F(RoomRecovery, a_fill_that_does_not_fit_the_gpu_is_refused_and_leaves_all_as_it_was) {
  const Layer other = make_layer(ValueType::u32, 2048, "other"),
              layer = make_layer(ValueType::u32, 4096, "large");
  restart_with_little_gpu_memory({other, layer});
  const auto before = room()->queries().tiles(layer.slug, {});
  const Answer filled = send(request(layer, room::FillEdit{false, 3}));
  ASSERT_FALSE(filled);
  EXPECT_EQ(filled.error().code, ErrorCode::out_of_memory);
  EXPECT_TRUE(test::equal(room()->queries().tiles(layer.slug, {})->tiles, before->tiles));
  const auto next = send_until_taken(stroke(layer, 7, {{310, 250}}, 20));
  ASSERT_TRUE(next) << next.error().detail;
  expect_room_equals_journal(layer);
  expect_picture_of_journal();
}

TEST_F(RoomRecovery, what_was_erased_comes_back_when_other_paint_has_taken_its_pages) {
  options_.retry_for = std::chrono::milliseconds(500);
  restart();
  const Layer a = make_layer(ValueType::u32, 2048, "a"), b = make_layer(ValueType::u32, 2048, "b");
  restart_with_little_gpu_memory({a});
  ASSERT_TRUE(send(request(a, room::FillEdit{false, 3})));
  const auto saved = room()->queries().tiles("a", {});
  Ears ears;
  auto member = room()->participants().join({"anna", Role::owner}, {}, &ears,
                                            [](const stream::FrameMessages&) {});

  Connection blocker(dsn_);
  blocker.execute("begin; lock table edits in exclusive mode");  // reads succeed, commits wait
  auto erased = start(request(a, room::FillEdit{true, 0}));
  auto filled = start(request(b, room::FillEdit{false, 4}));
  ears.wait_for_applied(2);
  EXPECT_TRUE(room()->queries().tiles("a", {})->tiles.empty());
  EXPECT_FALSE(erased.get());
  EXPECT_FALSE(filled.get());
  blocker.execute("rollback");

  EXPECT_TRUE(test::equal(room()->queries().tiles("a", {})->tiles, saved->tiles));
  EXPECT_TRUE(room()->queries().tiles(b.slug, {})->tiles.empty());
  expect_picture_of_journal();
  ASSERT_TRUE(send_until_taken(stroke(a, 8, {{300, 240}}, 20)));
  expect_room_equals_journal(a);
  expect_room_equals_journal(b);
}

TEST_F(RoomRecovery, contexts_lost_in_the_middle_of_edits_lose_none_that_was_saved) {
  const Layer layer = make_layer(ValueType::u8, 2048);
  ASSERT_TRUE(send(stroke(layer, 1, {{320, 240}}, 20)));
  std::vector<std::int64_t> sequences{1};
  // The context is lost after this number of edits: before and among the strokes, during the fill,
  // and after it.
  for (const int round : {0, 2, 4, 7}) {
    std::vector<std::future<Answer>> answers;
    for (int i = 0; i < 4; ++i)
      answers.push_back(start(stroke(layer, 10 + i, {{300.0 + 10 * i, 240.0 + round}}, 12)));
    answers.push_back(start(request(layer, room::FillEdit{false, std::uint32_t(round + 2)})));
    for (int i = 0; i < 4; ++i)
      answers.push_back(start(stroke(layer, 20 + i, {{310.0 + 10 * i, 240.0 - round}}, 12)));
    for (int i = 0; i < round; ++i) answers[i].wait();
    renderer_->lose_context_for_test();
    for (auto& future : answers) {
      const Answer answer = future.get();
      if (answer)
        sequences.push_back(answer->sequence);
      else
        EXPECT_THAT(answer.error().code,
                    ::testing::AnyOf(ErrorCode::gpu_lost, ErrorCode::unavailable))
            << answer.error().title;
    }
    const auto next = send_until_taken(stroke(layer, 40 + round, {{320, 230}}, 10));
    ASSERT_TRUE(next) << next.error().detail;
    sequences.push_back(next->sequence);
  }
  // Each sequence was assigned once, without a gap.
  for (std::size_t i = 0; i < sequences.size(); ++i) EXPECT_EQ(sequences[i], std::int64_t(i + 1));
  expect_room_equals_journal(layer);
  expect_picture_of_journal();
}

TEST_F(RoomRecovery, layers_made_changed_and_deleted_while_the_gpu_comes_back_stay_so) {
  make_layer(ValueType::u8, 2048, "kept");
  for (int round = 0; round < 4; ++round) {
    renderer_->lose_context_for_test();
    Layer made;
    made.name = made.slug = "made-" + std::to_string(round);
    made.type = ValueType::u8;
    made.resolution = 2048;
    made.palette = default_palette(made.type, false);
    Result<Layer> created = fail(ErrorCode::unavailable, "", "");
    for (int i = 0; i < 6000 && !created; ++i) created = room()->layers().create(made);
    ASSERT_TRUE(created) << created.error().detail;
    renderer_->lose_context_for_test();
    Layer renamed = room()->layers().find("kept").value();
    renamed.name = "Round " + std::to_string(round);
    ASSERT_TRUE(room()->layers().update(renamed));
    if (round % 2) {
      ASSERT_TRUE(room()->layers().erase(created->id));
    }
    EXPECT_EQ(room()->layers().find("kept")->name, renamed.name);
  }
  const Layer last = room()->layers().find("made-2").value();
  const auto painted = send_until_taken(stroke(last, 9, {{320, 240}}, 20));
  ASSERT_TRUE(painted) << painted.error().title << ": " << painted.error().detail;
  EXPECT_EQ(room()->layers().find("kept")->name, "Round 3");
  std::vector<std::string> here, stored;
  for (const auto& layer : room()->layers().all()) here.push_back(layer.slug + "/" + layer.name);
  const auto rows = store_->layers().of_model(model_.id, Role::owner);
  for (const auto& layer : *rows) stored.push_back(layer.slug + "/" + layer.name);
  EXPECT_EQ(here, stored);
  expect_picture_of_journal();
}

TEST_F(RoomRecovery, a_context_lost_after_the_rooms_are_gone_harms_nobody) {
  make_layer(ValueType::u8);
  rooms_.reset();
  renderer_->lose_context_for_test();
  std::promise<Result<render::ModelHandle>> answered;
  renderer_->add_model(
      {}, [&](Result<render::ModelHandle> model) { answered.set_value(std::move(model)); });
  EXPECT_FALSE(answered.get_future().get());  // the renderer still runs, and refuses the model
}

// --- The database

TEST_F(RoomRecovery, an_edit_whose_commit_was_in_doubt_is_answered_only_when_the_room_holds_it) {
  const Layer layer = make_layer(ValueType::u8);
  ASSERT_TRUE(send(stroke(layer, 5, {{300, 240}}, 20)));
  execute("alter table edits add constraint no_more check (sequence < 2) not valid");
  const auto edit = stroke(layer, 6, {{340, 240}}, 20);
  ASSERT_FALSE(send(edit));
  execute("alter table edits drop constraint no_more");
  commit_behind(edit, layer, 2, false);

  const auto resent = send(edit);
  ASSERT_TRUE(resent) << resent.error().detail;
  EXPECT_TRUE(resent->repeated);
  EXPECT_EQ(resent->sequence, 2);
  EXPECT_EQ(room()->edits().sequence(), 2);
  expect_room_equals_journal(layer);
  ASSERT_TRUE(send(stroke(layer, 7, {{320, 240}}, 20)));
  expect_room_equals_journal(layer);
  expect_picture_of_journal();
}

TEST_F(RoomRecovery, an_edit_that_reaches_the_journal_behind_the_room_is_not_painted_over) {
  const Layer layer = make_layer(ValueType::u8);
  ASSERT_TRUE(send(stroke(layer, 5, {{300, 240}}, 20)));
  commit_behind(stroke(layer, 6, {{340, 240}}, 20), layer, 2, false);
  // The room uses sequence 2 for its own edit. The journal refuses that edit, and the room reads
  // the stored edit.
  const auto edit = stroke(layer, 7, {{320, 240}}, 20);
  EXPECT_FALSE(send(edit));
  const auto resent = send_until_taken(edit);
  ASSERT_TRUE(resent) << resent.error().detail;
  EXPECT_EQ(resent->sequence, 3);
  expect_room_equals_journal(layer);
  expect_picture_of_journal();
}

TEST_F(RoomRecovery, only_roles_that_see_a_layer_are_told_that_it_was_read_again) {
  const Layer open = make_layer(ValueType::u8, 2048, "open");
  Layer hidden = *room()->layers().find(make_layer(ValueType::u8, 2048, "hidden").slug);
  hidden.visibility = Visibility::curators;
  ASSERT_TRUE(room()->layers().update(hidden));
  Ears curator, viewer;
  const auto nothing = [](const stream::FrameMessages&) {};
  const auto first = room()->participants().join({"anna", Role::curator}, {}, &curator, nothing);
  const auto second = room()->participants().join({"ben", Role::viewer}, {}, &viewer, nothing);
  commit_behind(stroke(hidden, 6, {{340, 240}}, 20), hidden, 1, false);
  EXPECT_FALSE(send(stroke(open, 7, {{320, 240}}, 20)));
  curator.wait_for_layer(hidden.id);
  EXPECT_EQ(std::ranges::count(viewer.layers(), hidden.id), 0);
}

TEST_F(RoomRecovery, a_room_that_cannot_be_read_again_refuses_edits_until_it_can) {
  const Layer layer = make_layer(ValueType::u8);
  ASSERT_TRUE(send(stroke(layer, 5, {{300, 240}}, 20)));
  const auto picture = test::whole_picture(room()->pictures(), {}, camera());
  const auto edit = stroke(layer, 6, {{340, 240}}, 20);
  commit_behind(edit, layer, 2, true);
  const auto refused = send(edit);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::unavailable);
  EXPECT_EQ(test::whole_picture(room()->pictures(), {}, camera())->rgba,
            picture->rgba);  // viewing still works

  execute(
      "update tile_revisions set difference = (select difference from tile_revisions where sequence = 1 limit 1) where sequence = 2");
  const auto resent = send_until_taken(edit);
  ASSERT_TRUE(resent) << resent.error().detail;
  EXPECT_TRUE(resent->repeated);
  expect_room_equals_journal(layer);
}

TEST_F(RoomRecovery, a_server_stops_though_a_room_cannot_be_read_again) {
  const Layer layer = make_layer(ValueType::u8);
  ASSERT_TRUE(send(stroke(layer, 5, {{300, 240}}, 20)));
  const auto edit = stroke(layer, 6, {{340, 240}}, 20);
  commit_behind(edit, layer, 2, true);
  auto waiting = start(edit);
  rooms_->drain();
  EXPECT_EQ(waiting.wait_for(std::chrono::seconds(0)), std::future_status::ready);
  rooms_.reset();  // joins every thread
}

TEST_F(RoomRecovery, a_database_that_hangs_holds_up_neither_the_room_nor_the_end_of_the_server) {
  options_.max_waiting_edits = 8;
  options_.drain_for = std::chrono::milliseconds(100);
  options_.retry_for = std::chrono::milliseconds(500);
  restart();
  const Layer layer = make_layer(ValueType::u8);
  ASSERT_TRUE(send(stroke(layer, 5, {{300, 240}}, 20)));
  Ears ears;
  auto member = room()->participants().join({"anna", Role::owner}, {}, &ears,
                                            [](const stream::FrameMessages&) {});
  ears.wait_for_presence(1);

  std::vector<std::future<Answer>> answers;
  {
    const test::Hang hang(test::shared_cluster());
    for (int i = 0; i < 12; ++i)
      answers.push_back(start(stroke(layer, 6 + i, {{300.0 + i, 240}}, 10)));
    for (int i = 8; i < 12; ++i) {
      ASSERT_EQ(answers[i].wait_for(std::chrono::seconds(0)), std::future_status::ready)
          << "refused before anything waits";
      EXPECT_EQ(answers[i].get().error().code, ErrorCode::too_many_requests);
    }
    member->pointer(room::Pointing{{1, 2, 3}, {}});
    ears.wait_for_presence(2);
    EXPECT_EQ(answers[0].wait_for(std::chrono::seconds(0)), std::future_status::timeout)
        << "the strand did not wait for the database";
    rooms_->drain();
    for (int i = 0; i < 8; ++i) EXPECT_EQ(answers[i].get().error().code, ErrorCode::unavailable);
    EXPECT_EQ(send(stroke(layer, 50, {{300, 240}}, 10)).error().code, ErrorCode::unavailable);
  }
  member.reset();
  restart();
  EXPECT_EQ(room()->edits().sequence(), 1);
}

TEST_F(RoomRecovery, edits_that_waited_for_the_database_keep_their_order) {
  options_.retry_for = std::chrono::milliseconds(60'000);
  restart();
  const Layer layer = make_layer(ValueType::u8);
  ASSERT_TRUE(send(stroke(layer, 1, {{300, 240}}, 20)));
  std::vector<std::future<Answer>> answers;
  {
    const test::Hang hang(test::shared_cluster());
    for (int i = 0; i < 40; ++i)
      answers.push_back(start(stroke(layer, 2 + i, {{300.0 + i % 5, 240}}, 12)));
  }
  for (int i = 0; i < 40; ++i) {
    const Answer answer = answers[i].get();
    ASSERT_TRUE(answer) << answer.error().detail;
    EXPECT_EQ(answer->sequence, i + 2);
  }
  expect_room_equals_journal(layer);
}

// --- Undo

TEST_F(RoomRecovery, undo_goes_back_through_more_revisions_than_are_read_at_once) {
  const Layer layer = make_layer(ValueType::u8, 2048, "layer");
  const Layer without_ben = make_layer(ValueType::u8, 2048, "without-ben");
  ASSERT_TRUE(send(stroke(layer, 200, {{320, 240}}, 30, "ben")));
  for (int i = 0; i < 70; ++i)
    for (const Layer* each : {&layer, &without_ben})
      ASSERT_TRUE(send(stroke(*each, 1 + i, {{312.0 + i % 9, 240.0 + i % 4}}, 8)));
  ASSERT_TRUE(send(request(layer, room::UndoEdit{}, "ben")));
  EXPECT_TRUE(test::equal(room()->queries().tiles("layer", {})->tiles,
                          room()->queries().tiles("without-ben", {})->tiles));
  ASSERT_TRUE(send(request(layer, room::RedoEdit{}, "ben")));
  EXPECT_TRUE(room()->queries().statistics("layer")->keys.contains(200));
}

// --- Closing

TEST_F(RoomRecovery, people_in_a_deleted_model_are_told_and_their_edits_are_refused_for_good) {
  const Layer layer = make_layer(ValueType::u8);
  const auto held = room();
  Ears ears;
  auto member = held->participants().join({"anna", Role::owner}, {}, &ears,
                                          [](const stream::FrameMessages&) {});
  ASSERT_TRUE(store_->models().remove(model_.id));
  rooms_->forget(model_.id);
  EXPECT_EQ(ears.deleted(), 1);
  std::promise<Answer> answered;
  held->edits().submit(stroke(layer, 5, {{300, 240}}, 20), {},
                       [&](Answer answer) { answered.set_value(std::move(answer)); });
  EXPECT_EQ(answered.get_future().get().error().code, ErrorCode::gone);
}

TEST_F(RoomRecovery, layers_of_a_closed_room_are_not_waited_for) {
  const Layer layer = make_layer(ValueType::u8);
  const auto held = room();
  ASSERT_TRUE(store_->models().remove(model_.id));
  rooms_->forget(model_.id);
  EXPECT_EQ(held->layers().erase(layer.id).error().code, ErrorCode::gone);
  EXPECT_EQ(held->layers().create(layer).error().code, ErrorCode::gone);
}

TEST_F(RoomRecovery, a_layer_that_waits_for_edits_is_answered_when_its_room_closes) {
  const Layer layer = make_layer(ValueType::u8);
  const auto held = room();
  std::future<Answer> painted;
  std::future<Result<void>> deleted;
  {
    const test::Hang hang(test::shared_cluster());
    painted = start(stroke(layer, 5, {{300, 240}}, 20));
    deleted = std::async(std::launch::async, [&] { return held->layers().erase(layer.id); });
    rooms_->forget(model_.id);
    EXPECT_EQ(painted.get().error().code, ErrorCode::gone);
    EXPECT_EQ(deleted.get().error().code, ErrorCode::gone);
  }
}

TEST_F(RoomRecovery,
       who_waits_until_the_rooms_are_settled_waits_for_what_is_on_its_way_to_the_journal) {
  options_.retry_for = std::chrono::milliseconds(60'000);
  restart();
  const Layer layer = make_layer(ValueType::u8);
  std::future<Answer> painted;
  std::future<Result<void>> settled;
  {
    const test::Hang hang(test::shared_cluster());
    painted = start(stroke(layer, 5, {{300, 240}}, 20));
    settled = std::async(std::launch::async, [&] { return rooms_->settle(); });
    EXPECT_EQ(settled.wait_for(std::chrono::milliseconds(50)), std::future_status::timeout);
  }
  ASSERT_TRUE(settled.get());
  EXPECT_EQ(room()->edits().durable_sequence(), 1);
  EXPECT_TRUE(painted.get());
}

TEST_F(RoomRecovery, rooms_that_close_before_they_are_settled_say_so) {
  options_.drain_for = std::chrono::milliseconds(100);
  restart();
  const Layer layer = make_layer(ValueType::u8);
  std::future<Answer> painted;
  {
    const test::Hang hang(test::shared_cluster());
    painted = start(stroke(layer, 5, {{300, 240}}, 20));
    auto settled = std::async(std::launch::async, [&] { return rooms_->settle(); });
    rooms_->drain();
    EXPECT_EQ(painted.get().error().code, ErrorCode::unavailable);
    const auto answer = settled.get();
    ASSERT_FALSE(answer) << "whether the edit is durable is not known";
    EXPECT_EQ(answer.error().code, ErrorCode::unavailable);
  }
}

TEST_F(RoomRecovery, no_layers_means_no_values) {
  make_layer(ValueType::u8);
  const auto point = room()->queries().position({0, 0, 0}, {});
  ASSERT_TRUE(point);
  EXPECT_TRUE(point->values.empty());
  EXPECT_EQ(room()->queries().position({0, 0, 0}, {"layer"})->values.size(), 1u);
}

}  // namespace
}  // namespace strata
