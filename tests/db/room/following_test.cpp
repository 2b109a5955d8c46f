// Two servers over one database, each as a node of the site. One has a model, and the other one
// follows its journal to show it. The oracle is the owner: at the same sequence, both rooms have
// the same layers, texels, marks and pictures.
#include <gmock/gmock.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <future>
#include <mutex>
#include <random>
#include <set>
#include <thread>

#include "room/edit.h"
#include "room/edits.h"
#include "room/layers.h"
#include "room/listener.h"
#include "room/participants.h"
#include "room/pictures.h"
#include "room/presence_message.h"
#include "room/queries.h"
#include "room/rooms.h"
#include "room/surface_images.h"
#include "store/content/models.h"
#include "store/content/trash.h"
#include "store/journal/journal_merger.h"
#include "store/journal/journal_reads.h"
#include "store/journal/journal_thinner.h"
#include "store/nodes/nodes.h"
#include "store/pg/pg.h"
#include "stream/viewer.h"
#include "support/room_fixture.h"
#include "support/whole_picture.h"

namespace strata {
namespace {

using test::RoomTest;
using Answer = Result<room::EditAnswer>;

constexpr auto kLong = std::chrono::minutes(5);

// A listener that records its events.
class Recorder : public room::Listener {
 public:
  void edit_applied(const Edit& edit) override {
    add([&] { edits.push_back(edit); });
  }
  void edits_unsaved(const std::vector<Edit>&, const Error&) override {}
  void layer_changed(LayerChange change, const Layer& layer) override {
    add([&] { layers.emplace_back(change, layer.slug); });
  }
  void model_changed(const Model& model) override {
    add([&] { names.push_back(model.name); });
  }
  void surface_image_changed(LayerChange, const SurfaceImage&) override {}
  void model_deleted() override {
    add([&] { is_deleted = true; });
  }
  void presence_changed() override {}
  void view_refused(std::uint32_t, const Error&) override {}
  void moved(const std::string&) override {
    add([&] { has_moved = true; });
  }
  void database_reachable(bool reachable) override {
    add([&] { database.push_back(reachable); });
  }

  // Waits until the events are as expected. `is_expected` may read the members.
  template <class IsExpected>
  bool wait(IsExpected is_expected) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, kLong, [&] { return is_expected(*this); });
  }

  std::vector<Edit> edits;
  std::vector<std::pair<LayerChange, std::string>> layers;
  std::vector<std::string> names;
  std::vector<bool> database;
  std::atomic<bool> is_deleted{false}, has_moved{false};

 private:
  template <class Add>
  void add(Add event) {
    std::lock_guard lock(mutex_);
    event();
    changed_.notify_all();
  }

  std::mutex mutex_;
  std::condition_variable changed_;
};

class Following : public RoomTest {
 protected:
  void SetUp() override {
    RoomTest::SetUp();
    rooms_.reset();
    join(a_);
    join(b_);
    options_.node = a_.id;
    restart();
    room::RoomOptions options;
    options.node = b_.id;
    options.stop_following_after = kLong;
    start_other(options);
    layer_ = make_layer(ValueType::u8);
  }
  // Node A opens the model again, with another epoch.
  void restart_owner() {
    rooms_ = std::make_unique<room::Rooms>(
        *store_, *renderer_, stream::StreamContext{renderer_.get(), encoder_.get()}, options_);
  }
  void start_other(const room::RoomOptions& options) {
    other_rooms_.reset();
    other_store_ = test::open_store(dsn_);
    other_rooms_ = std::make_unique<room::Rooms>(
        *other_store_, *renderer_, stream::StreamContext{renderer_.get(), encoder_.get()}, options);
  }
  void TearDown() override {
    participant_.reset();
    follower_.reset();
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
  void follow() {
    auto open = other_rooms_->follow("pot", Role::owner);
    ASSERT_TRUE(open) << open.error().detail;
    follower_ = *open;
    participant_ = follower_->participants().join({"vera", Role::viewer}, {}, &recorder_,
                                                  [](const stream::FrameMessages&) {});
  }
  std::vector<std::uint8_t> picture(room::Room& room) const {
    return test::whole_picture(room.pictures(), {}, camera({0.3, -1, 0.4}))->rgba;
  }
  // Returns the first difference between the rooms, or nothing.
  std::string difference() {
    const auto owner = room();
    if (owner->edits().durable_sequence() != follower_->edits().sequence()) return "sequence";
    const auto layers = owner->layers().all(), shown = follower_->layers().all();
    if (layers.size() != shown.size()) return "number of layers";
    for (std::size_t i = 0; i < layers.size(); ++i) {
      const Layer &one = layers[i], &other = shown[i];
      if (one.id != other.id || one.type != other.type || one.version != other.version ||
          one.sequence != other.sequence || one.opacity != other.opacity)
        return "layer " + one.slug;
      if (!test::equal(owner->queries().tiles(one.slug, {})->tiles,
                       follower_->queries().tiles(one.slug, {})->tiles))
        return "texels of " + one.slug;
    }
    // The marks of edits that wait for review are part of the picture.
    return picture(*owner) == picture(*follower_) ? "" : "picture";
  }
  void expect_follower_equals_owner() {
    const auto deadline = std::chrono::steady_clock::now() + kLong;
    std::string differs = difference();
    while (!differs.empty() && std::chrono::steady_clock::now() < deadline) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      differs = difference();
    }
    EXPECT_EQ(differs, "");
  }
  bool told(Recorder& recorder, room::Listener::LayerChange change, const std::string& slug) {
    return recorder.wait([&](const Recorder& now) {
      return std::ranges::find(now.layers, std::pair(change, slug)) != now.layers.end();
    });
  }
  // Waits until the follower shows a state that was requested after this call.
  void wait_until_asked() {
    const auto begun = std::chrono::steady_clock::now(), deadline = begun + kLong;
    const auto passed = [&] { return std::chrono::steady_clock::now() - begun; };
    while (other_rooms_->follower_lag() >= passed() && begun + passed() < deadline)
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    EXPECT_LT(begun + passed(), deadline);
  }
  // The tail cannot read states while this connection exists.
  store::PgConnection block_tail() {
    auto blocker = store::PgConnection::connect(dsn_);
    EXPECT_TRUE(blocker);
    EXPECT_TRUE(blocker->script("BEGIN; LOCK TABLE looks"));
    return std::move(*blocker);
  }
  // Makes the follower load the layer again, although its texels are damaged in the database. The
  // owner keeps it.
  void damage(const Layer& layer) {
    const std::string id = to_string(layer.id);
    script(
        "UPDATE all_layers SET binned = now(), binned_by = 'anna', binned_bytes = 0 WHERE id = " +
        id);
    ASSERT_TRUE(told(recorder_, room::Listener::LayerChange::deleted, layer.slug));
    script(
        "UPDATE tile_revisions SET difference = 'damaged', key_tile = NULL WHERE layer_id = " + id +
        "; UPDATE all_layers SET binned = NULL, binned_by = NULL, binned_bytes = NULL WHERE id = " +
        id);
  }
  // Sends a text to all nodes, as a node does.
  void send_presence(const std::string& text) {
    script("SELECT pg_notify(name, '" + text + "') FROM presence_channel");
  }
  // Waits until the condition is met. `retry` is called before each check.
  template <class Condition>
  static bool becomes(
      const Condition& condition, const std::function<void()>& retry = [] {}) {
    const auto deadline = std::chrono::steady_clock::now() + kLong;
    for (;;) {
      retry();
      if (condition()) return true;
      if (std::chrono::steady_clock::now() > deadline) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  }
  static std::unique_ptr<room::Participant> join(room::Room& room, const std::string& user,
                                                 Role role, room::Portrait portrait = {}) {
    return room.participants().join({user, role}, std::move(portrait), nullptr,
                                    [](const stream::FrameMessages&) {});
  }
  // Returns the names of the people that this participant sees, in alphabetical order.
  static std::string names(room::Room& room, const room::Participant& receiver) {
    std::set<std::string> users;
    for (const auto& person : room.participants().presence(receiver.session()))
      users.insert(person.user);
    std::string all;
    for (const std::string& user : users) all += user + " ";
    return all;
  }
  // Returns a person as this participant sees the person. Without a name: the participant does not
  // see the person.
  static room::Presence seen(room::Room& room, const room::Participant& receiver,
                             const std::string& user) {
    for (auto& person : room.participants().presence(receiver.session()))
      if (person.user == user) return person;
    return {};
  }
  std::optional<Uuid> owner() {
    const auto node = store_->nodes().owner_of("pot");
    return node && *node ? std::optional((*node)->id) : std::nullopt;
  }

  const store::NewNode a_{random_uuid(), "https://site.example/node/a", "1.0", "llvmpipe"},
      b_{random_uuid(), "https://site.example/node/b", "1.0", "llvmpipe"};
  std::unique_ptr<store::Store> other_store_;
  std::unique_ptr<room::Rooms> other_rooms_;
  Layer layer_;
  Recorder recorder_;
  std::shared_ptr<room::Room> follower_;
  std::unique_ptr<room::Participant> participant_;
};

TEST_F(Following, a_follower_shows_each_edit_and_claims_nothing) {
  ASSERT_TRUE(send(stroke(layer_, 5, {{300, 240}}, 20)));
  const auto epoch = store_->journal().state(model_.id, {})->epoch;
  follow();
  EXPECT_TRUE(other_rooms_->is_followed("pot"));
  EXPECT_EQ(other_rooms_->followed_models(), 1u);
  EXPECT_TRUE(other_rooms_->claims().empty());
  EXPECT_EQ(other_rooms_->elsewhere("pot").value(), a_.url) << "requests still go to the owner";
  expect_follower_equals_owner();
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(send(stroke(layer_, 6 + i, {{300 + 20.0 * i, 240}}, 20)));
  ASSERT_TRUE(recorder_.wait([](const Recorder& told) { return told.edits.size() == 3; }));
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(recorder_.edits[i].sequence, 2 + i);
    EXPECT_EQ(recorder_.edits[i].user, "anna");
    EXPECT_EQ(recorder_.edits[i].layer_id, layer_.id);
  }
  expect_follower_equals_owner();

  std::promise<Answer> refused;
  follower_->edits().submit(stroke(layer_, 9, {{300, 240}}, 20), {},
                            [&](Answer answer) { refused.set_value(std::move(answer)); });
  EXPECT_EQ(refused.get_future().get().error().code, ErrorCode::moved);
  EXPECT_EQ(owner(), a_.id);
  EXPECT_EQ(store_->journal().state(model_.id, {})->epoch, epoch);
  EXPECT_EQ(store_->journal().last_sequence(model_.id).value(), 4);
  EXPECT_FALSE(recorder_.has_moved);
}

TEST_F(Following, a_follower_refuses_every_change) {
  follow();
  const auto state = [&] { return store_->journal().model_state(model_.id).value(); };
  const auto before = state();
  const auto code = [](const auto& done) {
    return done ? std::nullopt : std::optional(done.error().code);
  };
  auto& layers = follower_->layers();
  auto& images = follower_->surface_images();
  Layer made = layer_;
  made.slug = made.name = "other";
  const std::vector<std::optional<ErrorCode>> codes{
      code(layers.create(made)),
      code(layers.update(layer_)),
      code(layers.widen(layer_, ValueType::u16)),
      code(layers.erase(layer_.id)),
      code(layers.put_in_trash(layer_.id, {})),
      code(layers.restore({}, {})),
      code(layers.mark_computed(layer_.id, "1", 0, {})),
      code(follower_->edits().keep_sums(layer_.id)),
      code(follower_->update_model(model_, {})),
      code(images.create({}, {})),
      code(images.update({})),
      code(images.erase(SurfaceImageId(1))),
  };
  EXPECT_THAT(codes, ::testing::Each(std::optional(ErrorCode::moved)));
  EXPECT_EQ(state(), before);
}

TEST_F(Following, any_edits_undos_decisions_and_changes_of_layers_arrive) {
  layer_.review = true;
  layer_ = room()->layers().update(layer_).value();
  const Layer plain = make_layer(ValueType::u8, 2048, "plain");
  ASSERT_TRUE(send(stroke(layer_, 5, {{300, 240}}, 20)));
  follow();
  std::mt19937 random(11);
  std::optional<Layer> extra;
  store::JournalMerger merger(store_->journal());
  const auto find = [&](const Layer& layer) { return room()->layers().find(to_string(layer.id)); };
  for (int step = 0; step < 48; ++step) {
    const std::string user = random() % 2 ? "anna" : "ben";
    const Layer& layer = random() % 2 ? layer_ : plain;
    // Some steps find nothing to change, and are refused.
    switch (random() % 12) {
      case 0: (void)send(request(layer, room::UndoEdit{}, user)); break;
      case 1: (void)send(request(layer, room::RedoEdit{}, user)); break;
      case 2:
      case 3: {
        constexpr Decision kDecisions[] = {Decision::accept, Decision::reject, Decision::reopen};
        auto edit =
            request(layer_, room::ReviewEdit{kDecisions[random() % 3], {{}, user}, ""}, "cleo");
        edit.author.role = Role::curator;
        edit.record = {{"op", "review"}};
        (void)send(edit);
        break;
      }
      case 4: {
        auto changed = find(layer).value();
        changed.opacity = static_cast<double>(random() % 10) / 10;
        ASSERT_TRUE(room()->layers().update(changed));
        break;
      }
      case 5:
        if (extra) {
          ASSERT_TRUE(room()->layers().put_in_trash(extra->id, {}));
          extra.reset();
        } else {
          extra = make_layer(ValueType::u8, 2048, "extra");
          ASSERT_TRUE(send(stroke(*extra, 3, {{320, 240}}, 30)));
        }
        break;
      case 6:
        if (extra && extra->type == ValueType::u8)
          extra = room()->layers().widen(find(*extra).value(), ValueType::u16).value();
        break;
      case 7: {
        const auto done = merger.merge(model_.id, store_->journal().state(model_.id, {})->epoch,
                                       std::chrono::system_clock::now() + std::chrono::hours(1),
                                       [] { return true; });
        ASSERT_TRUE(done) << done.error().detail;
        break;
      }
      default: {
        auto batch = stroke(layer, 1 + static_cast<double>(random() % 200),
                            {{260.0 + static_cast<double>(random() % 120), 240}}, 15, user);
        for (int n = 0; n < 3; ++n) {
          auto next = batch;
          next.id = random_uuid();
          next.record = {{"op", "stroke"}, {"n", n}, {"path", {{260, 240}, {261, 240 + n}}}};
          std::get<room::StrokeEdit>(next.edit).n = n;
          ASSERT_TRUE(send(next));
        }
      }
    }
    if (step % 8 == 7) expect_follower_equals_owner();
    if (HasFailure()) return;
  }
  EXPECT_EQ(owner(), a_.id);
  EXPECT_FALSE(recorder_.has_moved);
}

TEST_F(Following, layers_and_properties_of_the_model_arrive) {
  follow();
  using Change = room::Listener::LayerChange;
  const auto told = [&](Change change, const std::string& slug) {
    return Following::told(recorder_, change, slug);
  };
  const Layer late = make_layer(ValueType::u16, 2048, "Late");
  EXPECT_TRUE(told(Change::created, "late"));
  ASSERT_TRUE(room()->layers().put_in_trash(late.id, {}));
  EXPECT_TRUE(told(Change::deleted, "late"));
  layer_.locked = true;
  ASSERT_TRUE(room()->layers().update(layer_));
  EXPECT_TRUE(told(Change::changed, layer_.slug));
  EXPECT_TRUE(follower_->layers().find(layer_.slug)->locked);
  auto model = room()->model();
  model.name = "Pot of 1931";
  ASSERT_TRUE(room()->update_model(model, {}));
  EXPECT_TRUE(recorder_.wait([](const Recorder& now) { return !now.names.empty(); }));
  EXPECT_EQ(recorder_.names.back(), "Pot of 1931");
  expect_follower_equals_owner();
}

TEST_F(Following, a_layer_is_hidden_although_another_layer_cannot_be_loaded) {
  using Change = room::Listener::LayerChange;
  const Layer broken = make_layer(ValueType::u8, 2048, "broken");
  ASSERT_TRUE(send(stroke(broken, 5, {{300, 240}}, 20)));
  Layer secret = make_layer(ValueType::u8, 2048, "secret");
  follow();
  damage(broken);
  secret.visibility = Visibility::curators;
  ASSERT_TRUE(room()->layers().update(secret));
  EXPECT_TRUE(told(recorder_, Change::deleted, "secret"));
  ASSERT_TRUE(room()->layers().put_in_trash(layer_.id, {}));
  EXPECT_TRUE(told(recorder_, Change::deleted, layer_.slug));
  const Layer last = make_layer(ValueType::u8, 2048, "last");
  EXPECT_TRUE(told(recorder_, Change::created, "last"));
  const auto edit = send(stroke(last, 5, {{300, 240}}, 20));
  ASSERT_TRUE(edit);
  EXPECT_TRUE(recorder_.wait([&](const Recorder& now) {
    return !now.edits.empty() && now.edits.back().sequence == edit->sequence;
  })) << "the other layers follow the journal";
  EXPECT_FALSE(recorder_.has_moved);
}

TEST_F(Following, viewers_are_sent_to_the_owner_if_the_model_cannot_be_followed) {
  const Layer broken = make_layer(ValueType::u8, 2048, "broken");
  ASSERT_TRUE(send(stroke(broken, 5, {{300, 240}}, 20)));
  room::RoomOptions options;
  options.node = b_.id;
  options.stop_following_after = std::chrono::seconds(0);
  start_other(options);
  follow();
  EXPECT_FALSE(recorder_.has_moved);
  damage(broken);
  EXPECT_TRUE(recorder_.wait([](const Recorder& now) { return now.has_moved.load(); }));
  EXPECT_FALSE(other_rooms_->is_followed("pot"));
  const auto again = other_rooms_->follow("pot", Role::viewer);
  ASSERT_FALSE(again) << "not for a minute";
  EXPECT_EQ(again.error().code, ErrorCode::moved);
  EXPECT_EQ(again.error().location, a_.url);
  EXPECT_EQ(owner(), a_.id);
}

TEST_F(Following, a_node_with_too_little_memory_sends_viewers_to_the_owner) {
  room::RoomOptions options;
  options.node = b_.id;
  options.memory_bytes = 1000;
  start_other(options);
  const auto open = other_rooms_->follow("pot", Role::viewer);
  ASSERT_FALSE(open);
  EXPECT_EQ(open.error().code, ErrorCode::moved);
  EXPECT_EQ(open.error().location, a_.url);
  EXPECT_EQ(other_rooms_->follow("vase", Role::viewer).error().code, ErrorCode::not_found);
}

TEST_F(Following, a_layer_that_is_widened_and_hidden_at_once_is_deleted_for_viewers) {
  using Change = room::Listener::LayerChange;
  follow();
  script("UPDATE layers SET type = 'u16', visibility = 'private', version = version + 1");
  EXPECT_TRUE(told(recorder_, Change::deleted, layer_.slug));
}

TEST_F(Following, a_model_is_read_again_after_the_database_has_lost_edits) {
  ASSERT_TRUE(send(stroke(layer_, 5, {{300, 240}}, 20)));
  ASSERT_TRUE(send(stroke(layer_, 6, {{320, 240}}, 20)));
  follow();
  expect_follower_equals_owner();
  rooms_.reset();
  script(
      "BEGIN; DELETE FROM tile_revisions WHERE sequence = 2; DELETE FROM edits WHERE sequence = 2; "
      "UPDATE layers SET sequence = 1; UPDATE models SET sequence = 1; COMMIT");
  restart_owner();
  ASSERT_TRUE(send(stroke(layer_, 7, {{340, 240}}, 20)));
  EXPECT_EQ(store_->journal().last_sequence(model_.id).value(), 2);
  EXPECT_TRUE(recorder_.wait([](const Recorder& now) { return now.has_moved.load(); }));
  participant_.reset();
  follow();
  expect_follower_equals_owner();
}

TEST_F(Following, another_edit_with_the_sequence_of_a_lost_one_is_noticed) {
  ASSERT_TRUE(send(stroke(layer_, 5, {{300, 240}}, 20)));
  follow();
  expect_follower_equals_owner();
  script(
      "BEGIN; UPDATE edits SET id = gen_random_uuid(), time = time + interval '1 second'; "
      "UPDATE models SET owner_epoch = owner_epoch + 1; COMMIT");
  EXPECT_TRUE(recorder_.wait([](const Recorder& now) { return now.has_moved.load(); }));
}

TEST_F(Following, the_lag_grows_while_the_database_does_not_answer) {
  follow();
  const auto wait_for = [&](const auto& is_expected) {
    const auto deadline = std::chrono::steady_clock::now() + kLong;
    while (!is_expected(other_rooms_->follower_lag()) &&
           std::chrono::steady_clock::now() < deadline)
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    return is_expected(other_rooms_->follower_lag());
  };
  auto blocker = block_tail();
  EXPECT_TRUE(wait_for([](const auto lag) { return lag > std::chrono::seconds(2); }));
  ASSERT_TRUE(send(stroke(layer_, 5, {{300, 240}}, 20)));
  EXPECT_TRUE(recorder_.edits.empty());
  ASSERT_TRUE(blocker.script("COMMIT"));
  EXPECT_TRUE(recorder_.wait([](const Recorder& now) { return now.edits.size() == 1; }));
  EXPECT_TRUE(wait_for([](const auto lag) { return lag < std::chrono::seconds(2); }));
}

TEST_F(Following, more_edits_arrive_at_once_than_participants_are_notified_of) {
  follow();
  auto blocker = block_tail();
  std::vector<std::future<Answer>> answers;
  for (int i = 0; i < 260; ++i)
    answers.push_back(start(stroke(layer_, 1 + i % 9, {{260.0 + i % 120, 240}}, 10)));
  for (auto& answer : answers) ASSERT_TRUE(answer.get());
  ASSERT_TRUE(blocker.script("COMMIT"));
  EXPECT_TRUE(recorder_.wait(
      [](const Recorder& now) { return !now.edits.empty() && now.edits.back().sequence == 260; }));
  expect_follower_equals_owner();
}

TEST_F(Following, viewers_of_a_node_that_drains_are_sent_to_the_owner) {
  follow();
  other_rooms_->drain();
  EXPECT_TRUE(recorder_.wait([](const Recorder& now) { return now.has_moved.load(); }));
  EXPECT_FALSE(other_rooms_->may_follow());
  EXPECT_EQ(other_rooms_->elsewhere("pot").value(), a_.url);
  EXPECT_EQ(owner(), a_.id);
}

TEST_F(Following, a_node_can_be_told_to_follow_no_models) {
  EXPECT_TRUE(other_rooms_->may_follow());
  room::RoomOptions options;
  options.node = b_.id;
  options.follows = false;
  start_other(options);
  EXPECT_FALSE(other_rooms_->may_follow());
}

TEST_F(Following, the_marks_of_an_undo_arrive_without_those_of_other_strokes) {
  layer_.review = true;
  layer_ = room()->layers().update(layer_).value();
  ASSERT_TRUE(send(stroke(layer_, 5, {{300, 240}}, 20, "ben")));
  ASSERT_TRUE(send(stroke(layer_, 6, {{320, 240}}, 20, "anna")));
  follow();
  expect_follower_equals_owner();
  ASSERT_TRUE(send(request(layer_, room::UndoEdit{}, "anna")));
  expect_follower_equals_owner();
  ASSERT_TRUE(send(request(layer_, room::RedoEdit{}, "anna")));
  expect_follower_equals_owner();
}

TEST_F(Following, a_follower_continues_with_the_next_owner) {
  ASSERT_TRUE(send(stroke(layer_, 5, {{300, 240}}, 20)));
  follow();
  rooms_.reset();
  restart_owner();
  ASSERT_TRUE(send(stroke(layer_, 6, {{320, 240}}, 20)));
  expect_follower_equals_owner();
  EXPECT_FALSE(recorder_.has_moved);
}

// Another node thins the journal, up to the newest edit, and claims the model. The follower learns
// of both at once, and must not report that edits were lost.
TEST_F(Following, a_follower_continues_after_the_journal_was_thinned) {
  for (int i = 0; i < 6; ++i) ASSERT_TRUE(send(stroke(layer_, 5 + i, {{300 + 20.0 * i, 240}}, 20)));
  ASSERT_TRUE(send(request(layer_, room::UndoEdit{})));
  follow();
  script(
      "UPDATE edits SET time = date_trunc('day', time) - interval '60 days' + sequence * interval '1 minute'");
  wait_until_asked();
  rooms_.reset();
  auto blocker = block_tail();
  store::JournalThinner thinner(store_->journal());
  const auto done = thinner.thin(
      model_.id, {std::chrono::system_clock::now() - std::chrono::days(30), store::Period::day},
      [] { return true; });
  ASSERT_TRUE(done) << done.error().detail;
  EXPECT_EQ(done->removed, 5);
  script("UPDATE models SET owner_epoch = owner_epoch + 1");
  ASSERT_TRUE(blocker.script("COMMIT"));
  wait_until_asked();
  restart_owner();
  expect_follower_equals_owner();
  ASSERT_TRUE(send(stroke(layer_, 20, {{320, 240}}, 20)));
  expect_follower_equals_owner();
  ASSERT_TRUE(send(request(layer_, room::UndoEdit{})));
  expect_follower_equals_owner();
  EXPECT_FALSE(send(request(layer_, room::UndoEdit{}))) << "the other edits are in a checkpoint";
  EXPECT_FALSE(recorder_.has_moved);
}

TEST_F(Following, participants_connect_again_when_this_node_becomes_the_owner) {
  ASSERT_TRUE(send(stroke(layer_, 5, {{300, 240}}, 20)));
  follow();
  rooms_.reset();
  script("UPDATE nodes SET lease_until = clock_timestamp() - interval '1 second' WHERE id = '" +
         to_string(a_.id) + "'");
  wait_until_asked();
  EXPECT_FALSE(recorder_.has_moved) << "without an owner, the model is still shown";
  EXPECT_FALSE(picture(*follower_).empty());
  const auto open = other_rooms_->open("pot", Role::owner);
  ASSERT_TRUE(open) << open.error().detail;
  EXPECT_TRUE(recorder_.wait([](const Recorder& told) { return told.has_moved.load(); }));
  EXPECT_FALSE(other_rooms_->is_followed("pot"));
  const auto again = other_rooms_->follow("pot", Role::owner);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->get(), open->get()) << "viewers join the room of the owner";
}

TEST_F(Following, people_at_both_nodes_see_each_other) {
  follow();
  const auto owner_room = room();
  auto anna = join(*owner_room, "anna", Role::annotator, {"Anna Ost", "#112233"});
  const auto& vera = *participant_;
  ASSERT_TRUE(becomes([&] { return names(*follower_, vera) == "anna vera "; }));
  ASSERT_TRUE(becomes([&] { return names(*owner_room, *anna) == "anna vera "; }));
  const auto first = seen(*follower_, vera, "anna");
  EXPECT_EQ(first.session, anna->session());
  EXPECT_EQ(first.full_name, "Anna Ost");
  EXPECT_EQ(first.color, "#112233");
  EXPECT_FALSE(first.pointer);
  EXPECT_FALSE(first.leading);
  EXPECT_EQ(seen(*owner_room, *anna, "vera").session, vera.session());

  anna->pointer(room::Pointing{{1, 2, 3}, 0.5});
  ASSERT_TRUE(anna->look_together(true, std::nullopt));
  EXPECT_TRUE(becomes([&] {
    const auto now = seen(*follower_, vera, "anna");
    return now.pointer && now.pointer->position == glm::dvec3(1, 2, 3) &&
           now.pointer->radius == 0.5 && now.leading;
  }));
  participant_->pointer(room::Pointing{{4, 5, 6}, {}});
  EXPECT_TRUE(becomes([&] {
    const auto now = seen(*owner_room, *anna, "vera");
    return now.pointer && now.pointer->position == glm::dvec3(4, 5, 6);
  }));

  anna.reset();
  EXPECT_TRUE(becomes([&] { return names(*follower_, vera) == "vera "; }));
}

TEST_F(Following, people_follow_the_view_of_people_at_other_nodes) {
  follow();
  const auto owner_room = room();
  auto anna = join(*owner_room, "anna", Role::annotator);
  auto ben = join(*owner_room, "ben", Role::viewer);
  const auto& vera = *participant_;
  ASSERT_TRUE(becomes([&] { return names(*follower_, vera) == "anna ben vera "; }));
  ASSERT_TRUE(becomes([&] { return names(*owner_room, *anna) == "anna ben vera "; }));
  const Camera first = camera(), second = camera({0.3, -1, 0.4});
  anna->camera(0, 1, first, false);
  EXPECT_FALSE(seen(*follower_, vera, "anna").camera) << "nobody follows yet";
  ASSERT_TRUE(participant_->look_together(false, anna->session()));
  EXPECT_TRUE(becomes([&] { return seen(*follower_, vera, "anna").camera == first; }));
  EXPECT_EQ(seen(*owner_room, *anna, "vera").following, anna->session());
  anna->camera(0, 2, second, false);
  EXPECT_TRUE(becomes([&] { return seen(*follower_, vera, "anna").camera == second; }));
  auto wim = join(*follower_, "wim", Role::viewer);
  EXPECT_FALSE(seen(*follower_, *wim, "anna").camera) << "only followers get a camera";

  EXPECT_TRUE(becomes([&] {
    const auto cycle = anna->look_together(false, vera.session());
    return !cycle && cycle.error().code == ErrorCode::conflict;
  }));
  EXPECT_TRUE(becomes([&] { return ben->look_together(false, vera.session()).has_value(); }))
      << "through another person";
  EXPECT_EQ(ben->look_together(false, random_uuid()).error().code, ErrorCode::not_found);

  // A list changes nothing about people of other nodes.
  room::Presence false_vera, dora;
  false_vera.session = vera.session();
  dora.session = random_uuid();
  false_vera.user = dora.user = "dora";
  false_vera.color = dora.color = "#112233";
  const auto texts = room::presence_texts(random_uuid(), model_.id, std::vector{false_vera, dora});
  ASSERT_TRUE(becomes([&] { return names(*owner_room, *anna) == "anna ben dora vera wim "; },
                      [&] { send_presence(texts.front()); }));
  EXPECT_TRUE(
      becomes([&] { return seen(*owner_room, *anna, "vera").following == anna->session(); }));

  const Uuid left = anna->session();
  anna.reset();
  EXPECT_TRUE(becomes([&] { return seen(*follower_, vera, "anna").user.empty(); }));
  EXPECT_FALSE(seen(*follower_, vera, "vera").following);
  EXPECT_EQ(participant_->look_together(false, left).error().code, ErrorCode::not_found);
}

TEST_F(Following, people_of_several_nodes_who_follow_each_other_in_a_cycle_stop) {
  follow();
  const auto owner_room = room();
  auto anna = join(*owner_room, "anna", Role::annotator);
  // Carl is at a third node, which sends its list repeatedly, as every node does.
  room::Presence carl;
  carl.session = random_uuid();
  carl.user = "carl";
  carl.color = "#112233";
  const Uuid third = random_uuid();
  const auto send_carl = [&] {
    const auto texts = room::presence_texts(third, model_.id, {&carl, 1});
    send_presence(texts.front());
  };
  ASSERT_TRUE(becomes([&] { return names(*owner_room, *anna) == "anna carl vera "; }, send_carl));
  ASSERT_TRUE(
      becomes([&] { return anna->look_together(false, carl.session).has_value(); }, send_carl));
  carl.following = anna->session();
  EXPECT_TRUE(becomes([&] { return !seen(*owner_room, *anna, "anna").following; }, send_carl));
  EXPECT_TRUE(becomes([&] { return seen(*owner_room, *anna, "carl").following == anna->session(); },
                      send_carl))
      << "a later list begins no cycle";
}

TEST_F(Following, other_nodes_are_not_notified_of_kiosks) {
  follow();
  room::Portrait screen;
  screen.is_person = false;
  const auto kiosk = join(*follower_, "kiosk 3", Role::viewer, screen);
  const auto wim = join(*follower_, "wim", Role::viewer);
  const auto owner_room = room();
  const auto anna = join(*owner_room, "anna", Role::annotator);
  EXPECT_TRUE(becomes([&] { return names(*owner_room, *anna) == "anna vera wim "; }));
  EXPECT_TRUE(becomes([&] { return names(*follower_, *wim) == "anna kiosk 3 vera wim "; }));
}

TEST_F(Following, an_owner_sends_nothing_while_no_other_node_shows_the_model) {
  store::NewModel copy;
  copy.model = model_;
  copy.model.id = 0;
  copy.model.slug = "copy";
  copy.geometry = store_->models().geometry(model_.id).value();
  const auto second = store_->models().create(copy, {});
  ASSERT_TRUE(second) << second.error().detail;
  auto listener = store::PgConnection::connect(dsn_);
  ASSERT_TRUE(listener);
  const auto channel = listener->query("SELECT name FROM presence_channel");
  ASSERT_TRUE(channel && listener->script("LISTEN " + channel->text(0, 0)));
  std::vector<std::pair<ModelId, Uuid>> sent;  // the models and nodes of the texts
  const auto has_sent = [&](ModelId model, const Uuid& node) {
    const auto texts = listener->notifications(std::chrono::milliseconds(100));
    EXPECT_TRUE(texts);
    for (const auto& text : *texts) {
      const auto message = room::parse_presence(text).value();
      sent.emplace_back(message.model, message.node);
    }
    return std::ranges::find(sent, std::pair(model, node)) != sent.end();
  };

  const auto owner_room = room();
  const auto anna = join(*owner_room, "anna", Role::annotator);
  anna->pointer(room::Pointing{{1, 2, 3}, {}});
  const auto second_room = rooms_->open(to_string(second->id), Role::owner);
  ASSERT_TRUE(second_room) << second_room.error().detail;
  const auto ben = join(**second_room, "ben", Role::annotator);
  // A node sends the lists of all its models together. So when the list of the second model
  // arrives, which a third node shows, the list of the first model would have arrived, too.
  room::Presence carl;
  carl.session = random_uuid();
  carl.user = "carl";
  carl.color = "#112233";
  const auto texts = room::presence_texts(random_uuid(), second->id, {&carl, 1});
  EXPECT_TRUE(
      becomes([&] { return has_sent(second->id, a_.id); }, [&] { send_presence(texts.front()); }));
  for (const auto& [model, node] : sent) EXPECT_EQ(model, second->id);

  follow();
  EXPECT_TRUE(becomes([&] { return has_sent(model_.id, a_.id); }));
  const auto first = std::ranges::find(sent, model_.id, &std::pair<ModelId, Uuid>::first);
  ASSERT_NE(first, sent.end());
  EXPECT_EQ(first->second, b_.id);
}

TEST_F(Following, people_of_a_node_without_a_lease_disappear) {
  follow();
  const auto owner_room = room();
  const auto anna = join(*owner_room, "anna", Role::annotator);
  ASSERT_TRUE(becomes([&] { return names(*follower_, *participant_) == "anna vera "; }));
  script("UPDATE nodes SET lease_until = clock_timestamp() - interval '1 second' WHERE id = '" +
         to_string(a_.id) + "'");
  EXPECT_TRUE(becomes([&] { return names(*follower_, *participant_) == "vera "; }));
}

TEST_F(Following, people_in_a_room_that_is_closed_disappear) {
  follow();
  const auto wim = join(*follower_, "wim", Role::viewer);
  const auto owner_room = room();
  const auto anna = join(*owner_room, "anna", Role::annotator);
  ASSERT_TRUE(becomes([&] { return names(*owner_room, *anna) == "anna vera wim "; }));
  other_rooms_->drain();
  EXPECT_TRUE(becomes([&] { return names(*owner_room, *anna) == "anna "; }));
}

TEST_F(Following, malformed_presence_messages_are_refused) {
  ::testing::internal::CaptureStderr();
  follow();
  const auto owner_room = room();
  const auto anna = join(*owner_room, "anna", Role::annotator);
  // The second part of a list without the first one.
  const std::string part = R"({"node":")" + to_string(random_uuid()) + R"(","model":)" +
                           to_string(model_.id) + R"(,"part":1,"parts":2,"users":[]})";
  ASSERT_TRUE(becomes([&] { return names(*owner_room, *anna) == "anna vera "; }));
  ASSERT_TRUE(becomes([&] { return names(*follower_, *participant_) == "anna vera "; }));
  for (const std::string& text : {std::string("no JSON"), std::string(), part}) send_presence(text);
  // The names of people who come later arrive after these texts.
  const auto wim = join(*follower_, "wim", Role::viewer);
  const auto ben = join(*owner_room, "ben", Role::viewer);
  EXPECT_TRUE(becomes([&] { return names(*owner_room, *anna) == "anna ben vera wim "; }));
  EXPECT_TRUE(becomes([&] { return names(*follower_, *participant_) == "anna ben vera wim "; }));
  EXPECT_THAT(::testing::internal::GetCapturedStderr(),
              ::testing::HasSubstr("a presence message was refused"));
}

TEST_F(Following, a_deleted_model_is_no_longer_shown) {
  follow();
  script("UPDATE all_models SET binned = now(), binned_by = 'anna', binned_bytes = 0");
  EXPECT_TRUE(recorder_.wait([](const Recorder& told) { return told.is_deleted.load(); }));
  EXPECT_FALSE(other_rooms_->is_followed("pot"));
}

TEST_F(Following, a_node_without_a_lease_tells_viewers_and_catches_up_later) {
  follow();
  other_rooms_->suspend();
  EXPECT_TRUE(recorder_.wait([](const Recorder& told) { return told.database.size() == 1; }));
  EXPECT_EQ(other_rooms_->follow("pot", Role::viewer).error().code, ErrorCode::unavailable);
  ASSERT_TRUE(send(stroke(layer_, 6, {{320, 240}}, 20)));
  other_rooms_->resume();
  EXPECT_TRUE(recorder_.wait([](const Recorder& told) { return told.database.size() == 2; }));
  EXPECT_THAT(recorder_.database, ::testing::ElementsAre(false, true));
  expect_follower_equals_owner();
}

}  // namespace
}  // namespace strata
