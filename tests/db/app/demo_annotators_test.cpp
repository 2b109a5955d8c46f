// The recorded annotators of the demo: they paint while exactly one visitor is in the room, and
// then undo their strokes, so the model does not change.
#include "app/demo/demo_annotators.h"

#include <chrono>
#include <filesystem>
#include <set>
#include <string>
#include <thread>

#include "app/demo/demo_story.h"
#include "app/template_registry.h"
#include "room/edits.h"
#include "room/participants.h"
#include "room/queries.h"
#include "strata_dirs.h"
#include "support/quiet_services.h"
#include "support/room_fixture.h"

namespace strata::app {
namespace {

using namespace std::chrono_literals;

class Annotators : public test::RoomTest {
 protected:
  void SetUp() override {
    RoomTest::SetUp();
    const auto templates =
        TemplateRegistry::load(std::filesystem::path(STRATA_SOURCE_DIR) / "templates");
    ASSERT_TRUE(templates) << templates.error().detail;
    Progress progress;
    const auto story = make_demo_story(*store_, *templates, progress, 0.1);
    ASSERT_TRUE(story) << story.error().detail;
    pot_ = story->model;
    auto opened = rooms_->open(to_string(pot_.id), Role::owner);
    ASSERT_TRUE(opened) << opened.error().detail;
    room_ = *opened;
    before_ = tiles();
  }
  void TearDown() override {
    room_.reset();
    RoomTest::TearDown();
  }

  TileMap tiles() {
    auto content = room_->queries().tiles("condition", {});
    EXPECT_TRUE(content);
    return content ? content->tiles : TileMap{};
  }
  std::unique_ptr<room::Participant> visit(const std::string& user) {
    return room_->participants().join(Author(user, Role::viewer), {}, nullptr, [](const auto&) {});
  }
  // Waits until exactly these users are in the room. Fails after two minutes.
  void expect_here(const std::set<std::string>& users) {
    std::set<std::string> here;
    for (const auto end = std::chrono::steady_clock::now() + 2min;
         std::chrono::steady_clock::now() < end; std::this_thread::sleep_for(5ms)) {
      here.clear();
      for (const auto& person : room_->participants().presence({})) here.insert(person.user);
      if (here == users) return;
    }
    ADD_FAILURE() << here.size() << " people are here, the first is "
                  << (here.empty() ? "nobody" : *here.begin());
  }
  // Waits until `count` edits have followed `sequence`. Fails after two minutes.
  std::int64_t expect_edits_after(std::int64_t sequence, std::int64_t count = 1) {
    for (const auto end = std::chrono::steady_clock::now() + 2min;
         std::chrono::steady_clock::now() < end; std::this_thread::sleep_for(5ms))
      if (room_->edits().sequence() >= sequence + count) return room_->edits().sequence();
    ADD_FAILURE() << "nobody painted";
    return sequence;
  }

  void paint_and_leave();
  void leave_when_a_second_person_comes();
  void take_back_their_strokes_before_the_server_stops();

  static constexpr DemoAnnotators::Pace kFast{1ms, 1ms, 1ms, 1ms, 0min};
  test::QuietServices quiet_;
  Model pot_;
  std::shared_ptr<room::Room> room_;
  TileMap before_;
};

// All three parts of this test use one demo project, because its creation takes a long time.
TEST_F(Annotators, paint_for_a_lone_visitor_and_take_it_back) {
  paint_and_leave();
  leave_when_a_second_person_comes();
  take_back_their_strokes_before_the_server_stops();
}

void Annotators::paint_and_leave() {
  const std::int64_t first = room_->edits().sequence();
  const auto visitor = visit("vera");
  DemoAnnotators annotators(quiet_.of(*store_, *rooms_), kFast);
  annotators.visited(pot_);
  expect_here({"vera", kDemoConservator, kDemoCurator});
  for (const auto& person : room_->participants().presence({}))
    EXPECT_EQ(person.full_name.ends_with("(recorded)"), person.user != "vera") << person.user;
  expect_here({"vera"});
  EXPECT_GT(room_->edits().sequence(), first + 20) << "five strokes of several batches";
  EXPECT_TRUE(test::equal(tiles(), before_));
}

void Annotators::leave_when_a_second_person_comes() {
  const std::int64_t first = room_->edits().sequence();
  const auto vera = visit("vera");
  DemoAnnotators::Pace slow = kFast;
  slow.per_batch = 200ms;
  DemoAnnotators annotators(quiet_.of(*store_, *rooms_), slow);
  annotators.visited(pot_);
  expect_edits_after(first);
  const auto otto = visit("otto");
  expect_here({"vera", "otto"});
  EXPECT_TRUE(test::equal(tiles(), before_));
  // The annotators do not return while both visitors are in the room. `stop` returns after the
  // later visit has been handled.
  const std::int64_t then = room_->edits().sequence();
  annotators.visited(pot_);
  annotators.stop();
  EXPECT_EQ(room_->edits().sequence(), then);
}

void Annotators::take_back_their_strokes_before_the_server_stops() {
  const std::int64_t first = room_->edits().sequence();
  const auto vera = visit("vera");
  DemoAnnotators::Pace slow = kFast;
  slow.before_undo = 10min;
  DemoAnnotators annotators(quiet_.of(*store_, *rooms_), slow);
  annotators.visited(pot_);
  expect_edits_after(first, 10);
  annotators.stop();
  expect_here({"vera"});
  EXPECT_TRUE(test::equal(tiles(), before_));
}

using NotTheDemo = test::RoomTest;
TEST_F(NotTheDemo, is_not_visited) {
  const std::int64_t first = room()->edits().sequence();
  const auto visitor =
      room()->participants().join(Author("vera", Role::viewer), {}, nullptr, [](const auto&) {});
  test::QuietServices quiet;
  DemoAnnotators annotators(quiet.of(*store_, *rooms_), {1ms, 1ms, 1ms, 1ms, 0min});
  annotators.visited(model_);
  annotators.stop();
  EXPECT_EQ(room()->edits().sequence(), first);
}

}  // namespace
}  // namespace strata::app
