// Two servers with one database, each as a node of the site: a model is open on one of them. The
// other node gets the model when the lease of the first node ends, or when the first node drains.
#include <gmock/gmock.h>

#include <chrono>
#include <thread>

#include "protocol/frame_header.h"
#include "room/edit.h"
#include "room/edits.h"
#include "room/layers.h"
#include "room/listener.h"
#include "room/participants.h"
#include "room/queries.h"
#include "room/rooms.h"
#include "store/content/layers.h"
#include "store/content/models.h"
#include "store/content/trash.h"
#include "store/journal/journal_reads.h"
#include "store/nodes/nodes.h"
#include "store/pg/pg.h"
#include "stream/viewer.h"
#include "support/room_fixture.h"

namespace strata {
namespace {

using test::RoomTest;
using Answer = Result<room::EditAnswer>;

constexpr auto kLong = std::chrono::minutes(5);

// A listener that records where the model moved, and whether the node has its database.
class Follower : public room::Listener {
 public:
  void edit_applied(const Edit&) override {}
  void edits_unsaved(const std::vector<Edit>&, const Error&) override {}
  void layer_changed(LayerChange change, const Layer& layer) override {
    std::lock_guard lock(mutex_);
    layers_.emplace_back(change, layer.slug);
  }
  void model_changed(const Model& model) override {
    std::lock_guard lock(mutex_);
    models_.push_back(model.name);
  }
  void surface_image_changed(LayerChange, const SurfaceImage&) override {}
  void model_deleted() override {}
  void presence_changed() override {}
  void view_refused(std::uint32_t, const Error&) override {}
  void moved(const std::string& url) override {
    std::lock_guard lock(mutex_);
    urls_.push_back(url);
    changed_.notify_all();
  }
  void database_reachable(bool reachable) override {
    std::lock_guard lock(mutex_);
    reachable_.push_back(reachable);
    changed_.notify_all();
  }

  std::vector<std::string> wait() {
    std::unique_lock lock(mutex_);
    EXPECT_TRUE(changed_.wait_for(lock, kLong, [&] { return !urls_.empty(); }));
    return urls_;
  }
  // Waits until `count` notifications about the database have arrived, and returns them.
  std::vector<bool> wait_for_reachable(std::size_t count) {
    std::unique_lock lock(mutex_);
    EXPECT_TRUE(changed_.wait_for(lock, kLong, [&] { return reachable_.size() >= count; }));
    return reachable_;
  }
  std::vector<std::pair<LayerChange, std::string>> layers() {
    std::lock_guard lock(mutex_);
    return layers_;
  }
  std::vector<std::string> models() {
    std::lock_guard lock(mutex_);
    return models_;
  }
  std::vector<std::string> urls() {
    std::lock_guard lock(mutex_);
    return urls_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::string> urls_, models_;
  std::vector<std::pair<LayerChange, std::string>> layers_;
  std::vector<bool> reachable_;
};

// A viewer that turns the model.
class Viewer {
 public:
  Viewer(room::Room& room, room::Listener& listener)
      : participant_(room.participants().join(
            {"anna", Role::owner}, {}, &listener,
            [this](const stream::FrameMessages& frame) { take(frame); })) {}
  // Waits for a frame of this camera.
  bool turn_to(const Camera& camera) {
    participant_->camera(0, ++sent_, camera, false);
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, kLong, [&] { return drawn_ == sent_; });
  }

 private:
  void take(const stream::FrameMessages& frame) {
    std::lock_guard lock(mutex_);
    for (const auto& message : frame) {
      const auto header = protocol::decode_frame_header(*message);
      ASSERT_TRUE(header);
      if (!header->last) continue;
      drawn_ = header->camera_seq;
      participant_->ack(header->view_id, header->frame);
    }
    changed_.notify_all();
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::uint64_t sent_ = 0, drawn_ = 0;
  std::unique_ptr<room::Participant> participant_;  // destroyed first, because it sends frames
};

class TwoNodes : public RoomTest {
 protected:
  void SetUp() override {
    RoomTest::SetUp();
    rooms_.reset();  // the rooms of a server that is not a node
    join(a_);
    join(b_);
    options_.node = a_.id;
    restart();
    room::RoomOptions options;
    options.node = b_.id;
    other_store_ = test::open_store(dsn_);
    other_rooms_ = std::make_unique<room::Rooms>(
        *other_store_, *renderer_, stream::StreamContext{renderer_.get(), encoder_.get()}, options);
  }
  void TearDown() override {
    other_rooms_.reset();
    other_store_.reset();
    RoomTest::TearDown();
  }

  void script(const std::string& sql) {
    auto connection = store::PgConnection::connect(dsn_);
    ASSERT_TRUE(connection) << connection.error().detail;
    const auto done = connection->script(sql);
    ASSERT_TRUE(done) << done.error().detail;
  }
  // A lease that the test does not end lasts for the whole test.
  void join(const store::NewNode& node) {
    ASSERT_TRUE(store_->nodes().join(node));
    script("UPDATE nodes SET lease_until = clock_timestamp() + interval '1 hour' WHERE id = '" +
           to_string(node.id) + "'");
  }
  void end_lease(const store::NewNode& node) {
    script("UPDATE nodes SET lease_until = clock_timestamp() - interval '1 second' WHERE id = '" +
           to_string(node.id) + "'");
  }
  Answer send_to_b(room::EditRequest edit) {
    auto open = other_rooms_->open("pot", Role::owner);
    if (!open) return tl::unexpected(open.error());
    std::promise<Answer> answer;
    (*open)->edits().submit(std::move(edit), {},
                            [&](Answer result) { answer.set_value(std::move(result)); });
    return answer.get_future().get();
  }
  // Waits until the last user of the room has left, and the server has closed it.
  static void wait_until_closed(const room::Rooms& rooms) {
    const auto deadline = std::chrono::steady_clock::now() + kLong;
    while (rooms.open_rooms() > 0 && std::chrono::steady_clock::now() < deadline)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    EXPECT_EQ(rooms.open_rooms(), 0u);
  }

  const store::NewNode a_{random_uuid(), "https://site.example/node/a", "1.0", "llvmpipe"},
      b_{random_uuid(), "https://site.example/node/b", "1.0", "llvmpipe"};
  std::unique_ptr<store::Store> other_store_;
  std::unique_ptr<room::Rooms> other_rooms_;
};

TEST_F(TwoNodes, a_model_is_open_on_one_of_them) {
  const Layer layer = make_layer(ValueType::u8);
  ASSERT_TRUE(send(stroke(layer, 5, {{300, 240}}, 20)));
  const auto refused = other_rooms_->open("pot", Role::owner);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::moved);
  EXPECT_EQ(refused.error().location, a_.url);
  EXPECT_EQ(other_rooms_->elsewhere("pot").value(), a_.url);
  EXPECT_EQ(other_rooms_->elsewhere(to_string(model_.id)).value(), a_.url);
  EXPECT_EQ(rooms_->elsewhere("pot").value(), std::nullopt);
  EXPECT_EQ(other_rooms_->open_rooms(), 0u);
  EXPECT_TRUE(send(stroke(layer, 6, {{320, 240}}, 20))) << "the owner keeps it";
}

TEST_F(TwoNodes, the_next_owner_has_every_saved_edit_and_the_former_one_saves_none) {
  const Layer layer = make_layer(ValueType::u8);
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(send(stroke(layer, 10 + i, {{280.0 + 20 * i, 240}}, 20)));
  const auto open_on_a = room();
  Follower follower;
  auto participant = open_on_a->participants().join({"anna", Role::owner}, {}, &follower,
                                                    [](const stream::FrameMessages&) {});
  end_lease(a_);
  auto open_on_b = other_rooms_->open("pot", Role::owner);
  ASSERT_TRUE(open_on_b) << open_on_b.error().detail;
  const auto saved = other_store_->journal().load_tiles(layer).value();
  EXPECT_EQ(saved.sequence, 5);
  EXPECT_TRUE(test::equal((*open_on_b)->queries().tiles(layer.slug, {})->tiles, saved.tiles));

  // Node A has not detected yet that it is deposed.
  const auto edit = stroke(layer, 77, {{320, 240}}, 20);
  const auto refused = send(edit);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::moved);
  EXPECT_THAT(follower.wait(), ::testing::SizeIs(1));
  wait_until_closed(*rooms_);
  EXPECT_EQ(rooms_->models_moved(), 1u);
  EXPECT_EQ(store_->journal().last_sequence(model_.id).value(), 5);

  const auto first = send_to_b(edit);
  ASSERT_TRUE(first) << first.error().detail;
  EXPECT_EQ(first->sequence, 6);
  const auto again = send_to_b(edit);
  ASSERT_TRUE(again);
  EXPECT_TRUE(again->repeated);
  EXPECT_EQ(again->sequence, 6);
  EXPECT_EQ(other_store_->journal().last_sequence(model_.id).value(), 6);
  participant.reset();
}

TEST_F(TwoNodes, a_commit_under_way_is_refused_after_another_claim) {
  const Layer layer = make_layer(ValueType::u8);
  ASSERT_TRUE(send(stroke(layer, 5, {{300, 240}}, 20)));
  // The commit waits for this lock, and then finds the newer epoch.
  auto holder = store::PgConnection::connect(dsn_);
  ASSERT_TRUE(holder);
  ASSERT_TRUE(
      holder->script("BEGIN; UPDATE models SET owner_epoch = owner_epoch + 1, owner_node = '" +
                     to_string(b_.id) + "' WHERE id = " + to_string(model_.id)));
  const auto edit = stroke(layer, 6, {{320, 240}}, 20);
  auto answer = start(edit);
  bool waits = false;
  const auto deadline = std::chrono::steady_clock::now() + kLong;
  while (!waits && std::chrono::steady_clock::now() < deadline) {
    waits = holder->query("SELECT count(*) FROM pg_locks WHERE NOT granted")->integer(0, 0) > 0;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  ASSERT_TRUE(waits);
  ASSERT_TRUE(holder->script("COMMIT"));
  const auto refused = answer.get();
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::moved);
  EXPECT_EQ(refused.error().location, b_.url);
  wait_until_closed(*rooms_);
  EXPECT_EQ(send_to_b(edit)->sequence, 2);
}

TEST_F(TwoNodes, a_change_of_layers_notices_that_the_model_moved) {
  const Layer layer = make_layer(ValueType::u8);
  const auto open_on_a = room();
  end_lease(a_);
  ASSERT_TRUE(other_rooms_->open("pot", Role::owner));
  Layer late;
  late.name = late.slug = "late";
  late.type = ValueType::u8;
  late.resolution = 2048;
  late.palette = default_palette(late.type, false);
  const auto refused = open_on_a->layers().create(late);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::moved);
  wait_until_closed(*rooms_);
  EXPECT_FALSE(other_rooms_->open("pot", Role::owner).value()->layers().find("late"));
}

TEST_F(TwoNodes, a_node_without_a_lease_draws_and_saves_nothing_until_it_has_one_again) {
  const Layer layer = make_layer(ValueType::u8);
  ASSERT_TRUE(send(stroke(layer, 5, {{300, 240}}, 20)));
  Follower follower;
  const auto open_on_a = room();
  Viewer viewer(*open_on_a, follower);
  ASSERT_TRUE(viewer.turn_to(camera()));
  // The commit hangs, so the edit is neither saved nor refused.
  auto holder = store::PgConnection::connect(dsn_);
  ASSERT_TRUE(holder);
  ASSERT_TRUE(holder->script("BEGIN; SELECT 1 FROM models WHERE id = " + to_string(model_.id) +
                             " FOR UPDATE"));
  std::promise<void> visible;
  std::promise<Answer> answered;
  const auto edit = stroke(layer, 6, {{320, 240}}, 20);
  open_on_a->edits().submit(
      edit, [&](const room::EditAnswer&) { visible.set_value(); },
      [&](Answer answer) { answered.set_value(std::move(answer)); });
  visible.get_future().wait();

  rooms_->suspend();
  EXPECT_THAT(follower.wait_for_reachable(1), ::testing::ElementsAre(false));
  const auto answer = answered.get_future().get();
  ASSERT_FALSE(answer) << "an edit is not acknowledged without a lease";
  EXPECT_EQ(answer.error().code, ErrorCode::unavailable);
  std::promise<Answer> late;
  open_on_a->edits().submit(stroke(layer, 7, {{340, 240}}, 20), {},
                            [&](Answer result) { late.set_value(std::move(result)); });
  EXPECT_EQ(late.get_future().get().error().code, ErrorCode::unavailable);
  const auto refused = rooms_->open("pot", Role::owner);
  ASSERT_FALSE(refused) << "new users must come to a node with a lease";
  EXPECT_EQ(refused.error().code, ErrorCode::unavailable);
  EXPECT_EQ(rooms_->elsewhere("pot").value(), std::nullopt);
  EXPECT_TRUE(viewer.turn_to(camera({0.3, -1, 0.4}))) << "viewers can turn the model";

  // The commit succeeds after all. The repeated edit gets the same result.
  ASSERT_TRUE(holder->script("COMMIT"));
  rooms_->resume();
  EXPECT_THAT(follower.wait_for_reachable(2), ::testing::ElementsAre(false, true));
  const auto repeated = send_until_taken(edit);
  ASSERT_TRUE(repeated) << repeated.error().detail;
  EXPECT_EQ(repeated->sequence, 2);
  EXPECT_TRUE(repeated->repeated);
  EXPECT_EQ(store_->journal().last_sequence(model_.id).value(), 2);
  expect_room_equals_journal(layer);
  EXPECT_EQ(room().get(), open_on_a.get()) << "the room was not closed";
  EXPECT_THAT(follower.urls(), ::testing::IsEmpty());
  EXPECT_EQ(rooms_->models_moved(), 0u);
  EXPECT_EQ(send(stroke(layer, 8, {{340, 240}}, 20))->sequence, 3);
}

TEST_F(TwoNodes, a_model_that_another_node_claimed_meanwhile_is_not_saved_here_again) {
  const Layer layer = make_layer(ValueType::u8);
  ASSERT_TRUE(send(stroke(layer, 5, {{300, 240}}, 20)));
  Follower follower;
  const auto open_on_a = room();
  auto participant = open_on_a->participants().join({"anna", Role::owner}, {}, &follower,
                                                    [](const stream::FrameMessages&) {});
  rooms_->suspend();
  end_lease(a_);
  const auto there = send_to_b(stroke(layer, 9, {{320, 240}}, 20));
  ASSERT_TRUE(there) << there.error().detail;

  join(a_);
  rooms_->resume();
  EXPECT_THAT(follower.wait(), ::testing::SizeIs(1));
  EXPECT_THAT(follower.wait_for_reachable(1), ::testing::ElementsAre(false));
  std::promise<Answer> late;
  open_on_a->edits().submit(stroke(layer, 7, {{340, 240}}, 20), {},
                            [&](Answer result) { late.set_value(std::move(result)); });
  EXPECT_EQ(late.get_future().get().error().code, ErrorCode::moved);
  wait_until_closed(*rooms_);
  EXPECT_EQ(rooms_->models_moved(), 1u);
  EXPECT_EQ(store_->journal().last_sequence(model_.id).value(), there->sequence);
  participant.reset();
}

TEST_F(TwoNodes, a_model_that_was_put_in_the_trash_meanwhile_is_closed) {
  make_layer(ValueType::u8);
  Follower follower;
  const auto open_on_a = room();
  auto participant = open_on_a->participants().join({"anna", Role::owner}, {}, &follower,
                                                    [](const stream::FrameMessages&) {});
  rooms_->suspend();
  ASSERT_TRUE(other_store_->trash().put_model(model_.id, {}));  // node B needs no claim for this
  rooms_->resume();
  EXPECT_THAT(follower.wait(), ::testing::ElementsAre(""));
  wait_until_closed(*rooms_);
  EXPECT_EQ(rooms_->open("pot", Role::owner).error().code, ErrorCode::not_found);
  participant.reset();
}

TEST_F(TwoNodes, a_journal_with_more_edits_is_read_before_the_model_is_saved_again) {
  const Layer layer = make_layer(ValueType::u8);
  ASSERT_TRUE(send(stroke(layer, 5, {{300, 240}}, 20)));
  Follower follower;
  const auto open_on_a = room();
  auto participant = open_on_a->participants().join({"anna", Role::owner}, {}, &follower,
                                                    [](const stream::FrameMessages&) {});
  rooms_->suspend();
  // The effect of a commit whose response was lost: the journal has an edit that the room lacks.
  script("BEGIN; UPDATE models SET sequence = 2 WHERE id = " + to_string(model_.id) +
         "; UPDATE layers SET sequence = 2 WHERE id = " + to_string(layer.id) +
         "; INSERT INTO edits (model_id, sequence, id, layer_id, stroke, user_name, op, record, "
         "answer, time) SELECT model_id, 2, gen_random_uuid(), layer_id, gen_random_uuid(), "
         "user_name, op, record, answer, time FROM edits WHERE model_id = " +
         to_string(model_.id) + "; COMMIT");
  rooms_->resume();
  EXPECT_THAT(follower.wait_for_reachable(2), ::testing::ElementsAre(false, true));
  EXPECT_EQ(open_on_a->edits().durable_sequence(), 2);
  EXPECT_EQ(send(stroke(layer, 6, {{320, 240}}, 20))->sequence, 3);
  expect_room_equals_journal(layer);
  EXPECT_THAT(follower.urls(), ::testing::IsEmpty());
  participant.reset();
}

TEST_F(TwoNodes, changes_whose_responses_were_lost_are_read_before_the_model_is_saved_again) {
  using Change = room::Listener::LayerChange;
  using ::testing::Pair;
  Layer layer = make_layer(ValueType::u8, 2048, "find");
  ASSERT_TRUE(send(stroke(layer, 5, {{300, 240}}, 20)));
  const auto open_on_a = room();
  Follower owner, viewer;
  const auto ignored = [](const stream::FrameMessages&) {};
  auto first = open_on_a->participants().join({"anna", Role::owner}, {}, &owner, ignored);
  auto second = open_on_a->participants().join({"vic", Role::viewer}, {}, &viewer, ignored);
  rooms_->suspend();
  // The room does not know these changes, as if their responses were lost.
  layer = store_->layers().find(model_.id, to_string(layer.id), Role::owner).value();
  layer.visibility = Visibility::team;
  ASSERT_TRUE(store_->layers().update(layer));
  Model model = store_->models().find("pot").value();
  model.name = "Amphora";
  ASSERT_TRUE(store_->models().update(model));
  rooms_->resume();
  EXPECT_THAT(owner.wait_for_reachable(2), ::testing::ElementsAre(false, true));
  EXPECT_THAT(viewer.wait_for_reachable(2), ::testing::ElementsAre(false, true));
  EXPECT_EQ(open_on_a->layers().find(layer.slug)->visibility, Visibility::team);
  EXPECT_EQ(open_on_a->model().name, "Amphora");
  EXPECT_THAT(owner.layers(), ::testing::ElementsAre(Pair(Change::changed, layer.slug)));
  EXPECT_THAT(viewer.layers(), ::testing::ElementsAre(Pair(Change::deleted, layer.slug)));
  EXPECT_THAT(owner.models(), ::testing::ElementsAre("Amphora"));
  EXPECT_EQ(send(stroke(layer, 6, {{320, 240}}, 20))->sequence, 2);
  first.reset();
  second.reset();
}

TEST_F(TwoNodes,
       layers_that_changed_without_a_response_are_loaded_before_the_model_is_saved_again) {
  using Change = room::Listener::LayerChange;
  using ::testing::Pair;
  Layer wide = make_layer(ValueType::u8, 2048, "wide"),
        gone = make_layer(ValueType::u8, 2048, "gone");
  ASSERT_TRUE(send(stroke(wide, 5, {{300, 240}}, 20)));
  const auto open_on_a = room();
  Follower follower;
  auto participant = open_on_a->participants().join({"anna", Role::owner}, {}, &follower,
                                                    [](const stream::FrameMessages&) {});
  rooms_->suspend();
  wide = store_->layers().find(model_.id, to_string(wide.id), Role::owner).value();
  ASSERT_TRUE(store_->layers().widen(wide, ValueType::u16));
  ASSERT_TRUE(store_->trash().put_layer(gone.id, {}));
  Layer made = wide;
  made.name = made.slug = "made";
  made.type = ValueType::u8;
  made = store_->layers().create(made).value();
  rooms_->resume();
  EXPECT_THAT(follower.wait_for_reachable(2), ::testing::ElementsAre(false, true));
  EXPECT_THAT(follower.layers(), ::testing::UnorderedElementsAre(Pair(Change::changed, wide.slug),
                                                                 Pair(Change::deleted, gone.slug),
                                                                 Pair(Change::created, made.slug)));
  wide.type = ValueType::u16;
  EXPECT_EQ(send_until_taken(stroke(wide, 1000, {{320, 240}}, 20))->sequence, 2);
  EXPECT_EQ(send_until_taken(stroke(made, 7, {{320, 240}}, 20))->sequence, 3);
  expect_room_equals_journal(wide);
  expect_room_equals_journal(made);
  // The renderer of the comparison belongs to no node, so it can only open a model without an
  // owner.
  script("UPDATE all_models SET owner_node = NULL WHERE id = " + to_string(model_.id));
  expect_picture_of_journal();
  participant.reset();
}

TEST_F(TwoNodes, a_node_without_a_lease_stops_without_the_database) {
  make_layer(ValueType::u8);
  Follower follower;
  const auto open_on_a = room();
  auto participant = open_on_a->participants().join({"anna", Role::owner}, {}, &follower,
                                                    [](const stream::FrameMessages&) {});
  rooms_->suspend();
  rooms_->drain();
  EXPECT_THAT(follower.urls(), ::testing::ElementsAre(""));
  EXPECT_EQ(rooms_->open_rooms(), 0u);
  EXPECT_TRUE(store_->nodes().owner_of("pot").value()) << "the claim ends with the lease";
  participant.reset();
}

TEST_F(TwoNodes, a_participant_who_joins_late_is_notified_as_well) {
  make_layer(ValueType::u8);
  const auto open_on_a = room();
  rooms_->suspend();
  Follower follower;
  auto participant = open_on_a->participants().join({"anna", Role::owner}, {}, &follower,
                                                    [](const stream::FrameMessages&) {});
  EXPECT_THAT(follower.wait_for_reachable(1), ::testing::ElementsAre(false));
  end_lease(a_);
  ASSERT_TRUE(other_rooms_->open("pot", Role::owner));
  rooms_->resume();
  EXPECT_THAT(follower.wait(), ::testing::SizeIs(1));
  Follower later;
  auto second = open_on_a->participants().join({"ben", Role::owner}, {}, &later,
                                               [](const stream::FrameMessages&) {});
  EXPECT_THAT(later.wait(), ::testing::SizeIs(1));
}

TEST_F(TwoNodes, a_node_that_stops_passes_its_models_on) {
  const Layer layer = make_layer(ValueType::u8);
  Follower follower;
  const auto open_on_a = room();
  auto participant = open_on_a->participants().join({"anna", Role::owner}, {}, &follower,
                                                    [](const stream::FrameMessages&) {});
  std::vector<std::future<Answer>> answers;
  for (int i = 0; i < 5; ++i)
    answers.push_back(start(stroke(layer, 10 + i, {{280.0 + 20 * i, 240}}, 20)));
  ASSERT_TRUE(store_->nodes().begin_drain(a_.id));
  rooms_->drain();
  for (auto& answer : answers) EXPECT_TRUE(answer.get()) << "accepted edits are saved";
  EXPECT_THAT(follower.urls(), ::testing::ElementsAre(b_.url));
  EXPECT_EQ(rooms_->open_rooms(), 0u);
  EXPECT_EQ(rooms_->elsewhere("pot").value(), b_.url) << "even before B has opened it";
  EXPECT_EQ(rooms_->open("pot", Role::owner).error().code, ErrorCode::unavailable);

  auto open_on_b = other_rooms_->open("pot", Role::owner);
  ASSERT_TRUE(open_on_b) << open_on_b.error().detail;
  EXPECT_TRUE(test::equal((*open_on_b)->queries().tiles(layer.slug, {})->tiles,
                          other_store_->journal().load_tiles(layer)->tiles));
  EXPECT_EQ(send_to_b(stroke(layer, 9, {{320, 240}}, 20))->sequence, 6);
  participant.reset();
}

TEST_F(TwoNodes, a_closed_model_is_released) {
  make_layer(ValueType::u8);
  EXPECT_TRUE(store_->nodes().owner_of("pot").value());
  ASSERT_TRUE(store_->nodes().begin_drain(b_.id));
  rooms_->drain();  // without begin_drain of A: the release alone frees the model
  EXPECT_FALSE(store_->nodes().owner_of("pot").value());
}

}  // namespace
}  // namespace strata
