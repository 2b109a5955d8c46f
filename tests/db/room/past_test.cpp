// Earlier states of an open model: in views, as tiles, and after a restore.
#include <gtest/gtest.h>

#include <condition_variable>
#include <mutex>
#include <random>
#include <vector>

#include "protocol/frame_header.h"
#include "room/edit.h"
#include "room/edits.h"
#include "room/layers.h"
#include "room/participants.h"
#include "room/queries.h"
#include "store/journal/journal_reads.h"
#include "support/room_fixture.h"

namespace strata {
namespace {

using test::RoomTest;

constexpr auto kPatience = std::chrono::minutes(5);

// A browser that keeps the last complete full-quality frame of each view.
class Screen {
 public:
  struct Picture {
    protocol::FrameHeader header;
    std::vector<std::uint8_t> jpeg;
  };
  stream::SendFrames send() {
    return [this](const stream::FrameMessages& messages) {
      std::lock_guard lock(mutex_);
      for (const auto& message : messages) {
        const auto header = protocol::decode_frame_header(*message);
        ASSERT_TRUE(header);
        if (header->last && member) member->ack(header->view_id, header->frame);
        if (!header->keyframe || !header->still) continue;
        pictures_.push_back(
            {*header, {message->begin() + protocol::kFrameHeaderBytes, message->end()}});
      }
      changed_.notify_all();
    };
  }
  // Waits for a complete frame of this state with this camera.
  Picture wait(std::uint32_t view, std::int64_t sequence, std::uint64_t camera) {
    std::unique_lock lock(mutex_);
    Picture found;
    EXPECT_TRUE(changed_.wait_for(
        lock, kPatience,
        [&] {
          for (const Picture& picture : pictures_)
            if (picture.header.view_id == view && picture.header.camera_seq == camera &&
                static_cast<std::int64_t>(picture.header.scene_sequence) == sequence) {
              found = picture;
              return true;
            }
          return false;
        }))
        << "no picture of edit " << sequence;
    return found;
  }
  void forget() {
    std::lock_guard lock(mutex_);
    pictures_.clear();
  }

  std::shared_ptr<room::Participant> member;

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Picture> pictures_;
};

class RoomPast : public RoomTest {
 protected:
  void SetUp() override {
    RoomTest::SetUp();
    cracks_ = make_layer(ValueType::u8, 2048, "cracks");
    depth_ = make_layer(ValueType::f32, 2048, "depth");
  }
  static room::ViewSettings at(std::optional<std::int64_t> sequence) {
    room::ViewSettings settings;
    settings.at = sequence;
    return settings;
  }
  TileMap tiles(const Layer& layer, room::At at = {}) {
    return room()->queries().tiles(layer.slug, at)->tiles;
  }

  Layer cracks_, depth_;
};

TEST_F(RoomPast, a_view_shows_the_pictures_of_the_past_again) {
  Screen screen;
  screen.member = room()->participants().join({"anna", Role::owner}, {}, nullptr, screen.send());
  const Camera view = camera({0.3, -1, 0.4});
  std::uint64_t number = 0;
  struct Shown {
    std::int64_t sequence;
    std::vector<std::uint8_t> jpeg;
  };
  std::vector<Shown> shown;
  const auto show_now = [&] {
    const auto sequence = room()->edits().sequence();
    screen.member->show(0, at({}));
    // Use another camera in between, so the next frame is drawn completely.
    Camera other = view;
    other.width += 16;
    screen.member->camera(0, ++number, other, false);
    screen.wait(0, sequence, number);
    screen.member->camera(0, ++number, view, false);
    shown.push_back({sequence, screen.wait(0, sequence, number).jpeg});
  };
  show_now();
  ASSERT_TRUE(send(stroke(cracks_, 3, {{300, 240}}, 40)));
  show_now();
  ASSERT_TRUE(send(stroke(depth_, 0.5, {{320, 240}, {400, 260}}, 30)));
  show_now();
  auto erase = stroke(cracks_, 0, {{300, 240}}, 20);
  std::get<room::StrokeEdit>(erase.edit).batch.erase = true;
  ASSERT_TRUE(send(erase));
  show_now();
  ASSERT_TRUE(send(request(cracks_, room::UndoEdit{})));
  show_now();
  for (std::size_t i = 1; i < shown.size(); ++i) ASSERT_NE(shown[i].jpeg, shown[i - 1].jpeg);

  // Visit the states in both directions, in single steps and in larger steps.
  for (const std::size_t i : {0u, 4u, 1u, 2u, 3u, 2u, 0u, 3u}) {
    screen.forget();
    screen.member->show(0, at(shown[i].sequence));
    EXPECT_EQ(screen.wait(0, shown[i].sequence, number).jpeg, shown[i].jpeg) << i;
  }
  // Edits by others do not change the past, and they are visible after the return to the present.
  ASSERT_TRUE(send(stroke(cracks_, 7, {{330, 250}}, 30, "ben")));
  screen.forget();
  screen.member->show(0, at(shown[1].sequence));
  EXPECT_EQ(screen.wait(0, shown[1].sequence, number).jpeg, shown[1].jpeg);
  screen.member->show(0, at({}));
  const auto now = screen.wait(0, room()->edits().sequence(), number);
  EXPECT_NE(now.jpeg, shown[4].jpeg);

  // A second view shows an earlier state next to the present one.
  screen.forget();
  screen.member->show(1, at(shown[2].sequence));
  screen.member->camera(1, 1, view, false);
  EXPECT_EQ(screen.wait(1, shown[2].sequence, 1).jpeg, shown[2].jpeg);
  screen.member.reset();
}

TEST_F(RoomPast, a_lost_context_does_not_end_the_view_of_the_past) {
  ASSERT_TRUE(send(stroke(cracks_, 3, {{300, 240}}, 40)));
  Screen screen;
  screen.member = room()->participants().join({"anna", Role::owner}, {}, nullptr, screen.send());
  const Camera view = camera({0.3, -1, 0.4});
  screen.member->camera(0, 1, view, false);
  const auto before = screen.wait(0, 1, 1);
  ASSERT_TRUE(send(stroke(cracks_, 5, {{310, 240}}, 40)));
  screen.forget();
  screen.member->show(0, at(1));
  EXPECT_EQ(screen.wait(0, 1, 1).jpeg, before.jpeg);
  screen.forget();
  renderer_->lose_context_for_test();
  EXPECT_EQ(screen.wait(0, 1, 1).jpeg, before.jpeg);
  screen.member.reset();
}

// Expects that the tiles of each state can be loaded if the tiles of any other state are given.
TEST_F(RoomPast, every_state_is_read_from_every_other_one) {
  std::mt19937 random(7);
  std::vector<TileMap> states{{}};  // by sequence
  const auto any = [&](int low, int high) {
    return std::uniform_int_distribution<int>(low, high)(random);
  };
  for (int i = 0; i < 90; ++i) {
    const int kind = any(0, 9);
    auto edit =
        stroke(cracks_, any(1, 9), {{double(any(200, 440)), double(any(160, 320))}}, any(5, 40));
    if (kind < 2) std::get<room::StrokeEdit>(edit.edit).batch.erase = true;
    if (kind == 2) edit = request(cracks_, room::FillEdit{true, 0});
    if (kind == 3) edit = request(cracks_, room::UndoEdit{});
    const auto done = send(edit);
    if (!done) continue;  // no edit to undo
    ASSERT_EQ(done->sequence, static_cast<std::int64_t>(states.size()));
    states.push_back(tiles(cracks_));
  }
  store::Journal& journal = store_->journal();
  for (int i = 0; i < 60; ++i) {
    const auto from = any(0, static_cast<int>(states.size()) - 1);
    const auto to = any(0, static_cast<int>(states.size()) - 1);
    const auto found = journal.load_tiles_near(cracks_, to, {states[from], from});
    ASSERT_TRUE(found) << found.error().detail;
    EXPECT_EQ(found->sequence, to);
    EXPECT_TRUE(test::equal(found->tiles, states[to])) << from << " to " << to;
  }
  const auto last = journal.layer_sequences(model_.id, 40);
  ASSERT_TRUE(last);
  EXPECT_EQ(last->at(cracks_.id), 40);
  EXPECT_FALSE(last->contains(depth_.id));
}

TEST_F(RoomPast, a_restore_changes_what_the_difference_counts) {
  ASSERT_TRUE(send(stroke(cracks_, 3, {{260, 240}, {400, 240}}, 30)));
  ASSERT_TRUE(send(stroke(cracks_, 9, {{280, 240}, {380, 240}}, 20, "ben")));
  const auto then = tiles(cracks_, 1), now = tiles(cracks_);

  const room::Outline left{camera(), {{0, 0}, {330, 0}, {330, 480}, {0, 480}}, false};
  const auto part = room()->queries().difference("cracks", 1, {}, left);
  const auto whole = room()->queries().difference("cracks", 1, {}, {});
  ASSERT_TRUE(part && whole);
  EXPECT_GT(part->texels, 0u);
  EXPECT_LT(part->texels, whole->texels);
  EXPECT_EQ(room()->queries().difference("cracks", {}, 1, {})->texels, whole->texels);
  EXPECT_EQ(room()->queries().difference("cracks", 1, 1, {})->texels, 0u);

  const auto restored = send(request(cracks_, room::RestoreEdit{1, left}));
  ASSERT_TRUE(restored) << restored.error().detail;
  EXPECT_EQ(restored->texels_changed, part->texels);
  EXPECT_NEAR(restored->area_m2, part->area_m2, 1e-9 * part->area_m2);
  EXPECT_EQ(room()->queries().difference("cracks", 1, {}, left)->texels, 0u);
  EXPECT_EQ(room()->queries().difference("cracks", 1, {}, {})->texels,
            whole->texels - part->texels);

  // The restore is one edit, so one undo is enough.
  ASSERT_TRUE(send(request(cracks_, room::UndoEdit{})));
  EXPECT_TRUE(test::equal(tiles(cracks_), now));
  const auto all = send(request(cracks_, room::RestoreEdit{1, {}}));
  ASSERT_TRUE(all);
  EXPECT_EQ(all->texels_changed, whole->texels);
  EXPECT_TRUE(test::equal(tiles(cracks_), then));

  const auto never = room()->queries().difference("cracks", 1000, {}, {});
  ASSERT_FALSE(never);
  EXPECT_EQ(never.error().code, ErrorCode::invalid);
}

TEST_F(RoomPast, a_viewer_sees_nothing_of_restricted_layers_in_the_past) {
  const Camera view = camera({0.3, -1, 0.4});
  Screen screen;
  screen.member = room()->participants().join({"vera", Role::viewer}, {}, nullptr, screen.send());
  screen.member->camera(0, 1, view, false);
  const auto bare = screen.wait(0, 0, 1);
  ASSERT_TRUE(send(stroke(cracks_, 3, {{300, 240}}, 60)));
  Layer layer = *room()->layers().find("cracks");
  layer.visibility = Visibility::curators;
  ASSERT_TRUE(room()->layers().update(layer, {}));
  screen.forget();
  screen.member->show(0, at(1));
  EXPECT_EQ(screen.wait(0, 1, 1).jpeg, bare.jpeg);
  screen.member.reset();
}

}  // namespace
}  // namespace strata
