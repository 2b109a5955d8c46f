#include "stream/flow_control.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

namespace strata::stream {
namespace {

using Quality = FlowControl::Quality;
using Box = FlowControl::Box;

Camera camera_at(double x) {
  Camera camera;
  camera.view[3][0] = x;
  camera.width = 640;
  camera.height = 480;
  return camera;
}

Box box_at(float x) { return {glm::vec3(x), glm::vec3(x + 1)}; }

FlowControl ready(int window) {
  FlowControl flow(window);
  flow.on_ready();
  return flow;
}

// Draws, sends and acknowledges all frames of the flow. Returns the number of draws.
int settle(FlowControl& flow) {
  int draws = 0;
  while (auto draw = flow.next()) {
    ++draws;
    if (auto number = flow.on_drawn(draw->ticket, true)) flow.on_ack(number->frame);
  }
  return draws;
}

TEST(StreamFlow, nothing_is_drawn_before_the_view_exists_and_a_camera_came) {
  FlowControl flow(2);
  flow.on_camera(1, camera_at(1), false);
  EXPECT_FALSE(flow.next());
  flow.on_ready();
  EXPECT_TRUE(flow.next());

  FlowControl other = ready(2);
  other.on_change(box_at(0), 3);
  other.on_style();
  EXPECT_FALSE(other.next());
}

TEST(StreamFlow, what_was_refused_waits_for_something_to_change) {
  FlowControl flow = ready(2);
  flow.on_camera(1, camera_at(1), false);
  auto draw = flow.next();
  ASSERT_TRUE(draw);
  EXPECT_TRUE(flow.on_refused(draw->ticket));
  flow.on_ack(0);
  EXPECT_FALSE(flow.next());
  flow.on_style();
  draw = flow.next();
  ASSERT_TRUE(draw);
  EXPECT_FALSE(draw->changed) << "the refused draw gave back that everything waits";
  flow.on_camera(2, camera_at(2), false);  // changed during the draw
  EXPECT_TRUE(flow.on_refused(draw->ticket));
  EXPECT_TRUE(flow.next());
}

TEST(StreamFlow, the_newest_camera_wins_and_the_others_are_counted_as_dropped) {
  FlowControl flow = ready(2);
  flow.on_camera(1, camera_at(1), true);
  const auto first = flow.next();
  ASSERT_TRUE(first);
  for (int i = 2; i <= 5; ++i) flow.on_camera(i, camera_at(i), true);
  EXPECT_FALSE(flow.next()) << "one draw at a time";
  flow.on_drawn(first->ticket, true);
  const auto second = flow.next();
  ASSERT_TRUE(second);
  EXPECT_EQ(second->camera_seq, 5u);
  EXPECT_EQ(second->camera, camera_at(5));
  EXPECT_EQ(flow.dropped(), 3u);
}

TEST(StreamFlow, without_credit_nothing_is_drawn_until_the_client_acknowledges) {
  FlowControl flow = ready(2);
  for (int i = 1; i <= 2; ++i) {
    flow.on_camera(i, camera_at(i), true);
    const auto draw = flow.next();
    ASSERT_TRUE(draw);
    EXPECT_EQ(flow.on_drawn(draw->ticket, true)->frame, std::uint64_t(i));
  }
  flow.on_camera(3, camera_at(3), true);
  EXPECT_FALSE(flow.next());
  flow.on_ack(1);
  const auto draw = flow.next();
  ASSERT_TRUE(draw);
  EXPECT_EQ(draw->camera_seq, 3u);
}

TEST(StreamFlow, an_acknowledgement_of_a_frame_that_was_never_sent_gives_no_credit_in_advance) {
  FlowControl flow = ready(1);
  flow.on_ack(1'000'000);
  flow.on_camera(1, camera_at(1), false);
  const auto draw = flow.next();
  ASSERT_TRUE(draw);
  flow.on_drawn(draw->ticket, true);
  flow.on_change(box_at(0), 1);
  EXPECT_FALSE(flow.next());
  flow.on_ack(1);
  EXPECT_TRUE(flow.next());
}

TEST(StreamFlow, an_edit_while_the_camera_moves_is_added_to_the_picture_as_it_is) {
  FlowControl flow = ready(2);
  flow.on_camera(1, camera_at(1), true);
  auto draw = flow.next();
  ASSERT_TRUE(draw);
  EXPECT_EQ(draw->quality, Quality::moving);
  flow.on_ack(flow.on_drawn(draw->ticket, true)->frame);
  flow.on_change(box_at(0), 5);
  draw = flow.next();
  ASSERT_TRUE(draw && draw->changed);
  EXPECT_EQ(draw->quality, Quality::moving);
  const auto number = flow.on_drawn(draw->ticket, true);
  EXPECT_FALSE(number->still);
  flow.on_ack(number->frame);
  flow.on_quiet();
  draw = flow.next();
  ASSERT_TRUE(draw);
  EXPECT_FALSE(draw->changed) << "all is refined";
  EXPECT_EQ(draw->quality, Quality::still);
  flow.on_ack(flow.on_drawn(draw->ticket, true)->frame);
  flow.on_change(box_at(0), 6);
  EXPECT_EQ(flow.next()->quality, Quality::still);
}

TEST(StreamFlow, the_window_may_change_at_any_time) {
  FlowControl flow = ready(1);
  for (int i = 1; i <= 3; ++i) {
    flow.set_window(i);
    flow.on_camera(i, camera_at(i), true);
    const auto draw = flow.next();
    ASSERT_TRUE(draw);
    flow.on_drawn(draw->ticket, true);
  }
  flow.set_window(0);  // counts as 1
  flow.on_camera(4, camera_at(4), true);
  flow.on_ack(2);
  EXPECT_FALSE(flow.next());
  flow.on_ack(3);
  EXPECT_TRUE(flow.next());
}

TEST(StreamFlow, nothing_changed_means_nothing_is_drawn) {
  FlowControl flow = ready(2);
  flow.on_camera(1, camera_at(1), false);
  EXPECT_EQ(settle(flow), 1);
  EXPECT_FALSE(flow.next());
  flow.on_camera(2, camera_at(1), false);
  flow.on_quiet();
  flow.on_ack(1);
  EXPECT_FALSE(flow.next());
  flow.on_change(box_at(0), 7);
  const auto draw = flow.next();
  ASSERT_TRUE(draw);
  EXPECT_EQ(draw->camera_seq, 2u)
      << "frames echo the newest number, also of a camera that is where it was";
}

TEST(StreamFlow, an_edit_redraws_only_its_box_at_full_quality) {
  FlowControl flow = ready(2);
  flow.on_camera(1, camera_at(1), false);
  settle(flow);
  flow.on_change(box_at(3), 12);
  const auto draw = flow.next();
  ASSERT_TRUE(draw);
  ASSERT_TRUE(draw->changed);
  ASSERT_EQ(draw->changed->size(), 1u);
  EXPECT_EQ(draw->changed->front().min, glm::vec3(3));
  EXPECT_EQ(draw->quality, Quality::still);
  EXPECT_EQ(draw->sequence, 12);
}

TEST(StreamFlow, edits_that_come_while_there_is_no_credit_are_drawn_together_once_it_returns) {
  FlowControl flow = ready(1);
  flow.on_camera(1, camera_at(1), false);
  const auto first = flow.next();
  flow.on_drawn(first->ticket, true);
  for (int i = 0; i < 10; ++i) flow.on_change(box_at(float(i)), 100 + i);
  EXPECT_FALSE(flow.next());
  flow.on_ack(1);
  const auto draw = flow.next();
  ASSERT_TRUE(draw && draw->changed);
  EXPECT_EQ(draw->changed->size(), 10u);
  EXPECT_EQ(draw->sequence, 109);
}

TEST(StreamFlow, a_draw_takes_in_the_edits_that_came_while_it_waited_for_its_turn) {
  FlowControl flow = ready(2);
  flow.on_camera(1, camera_at(1), false);
  settle(flow);
  flow.on_change(box_at(1), 1);
  const auto draw = flow.next();
  ASSERT_TRUE(draw);
  flow.on_change(box_at(2), 2);
  flow.on_change(box_at(3), 3);
  EXPECT_EQ(flow.on_begun(draw->ticket), (std::vector{box_at(2), box_at(3)}));
  flow.on_change(box_at(4), 4);  // the frame has begun, so it does not show this edit
  const auto number = flow.on_drawn(draw->ticket, true);
  ASSERT_TRUE(number);
  EXPECT_EQ(number->sequence, 3);
  const auto next = flow.next();
  ASSERT_TRUE(next);
  EXPECT_EQ(next->changed, std::vector{box_at(4)});
  EXPECT_EQ(next->sequence, 4);
  EXPECT_TRUE(flow.on_begun(draw->ticket).empty()) << "a ticket that is not valid";
}

TEST(StreamFlow, a_draw_that_fails_gives_back_what_it_took_in) {
  FlowControl flow = ready(2);
  flow.on_camera(1, camera_at(1), false);
  settle(flow);
  flow.on_change(box_at(1), 1);
  const auto draw = flow.next();
  flow.on_change(box_at(2), 2);
  flow.on_begun(draw->ticket);
  EXPECT_TRUE(flow.on_failed(draw->ticket));
  const auto again = flow.next();
  ASSERT_TRUE(again && again->changed);
  EXPECT_EQ(*again->changed, (std::vector{box_at(1), box_at(2)}));
  EXPECT_EQ(again->sequence, 2);
}

TEST(StreamFlow, a_whole_picture_shows_every_edit_before_its_turn) {
  FlowControl flow = ready(2);
  flow.on_camera(1, camera_at(1), false);
  const auto draw = flow.next();
  flow.on_change(box_at(1), 1);
  flow.on_change_everywhere(2);
  EXPECT_TRUE(flow.on_begun(draw->ticket).empty()) << "it has no rectangles";
  EXPECT_EQ(flow.on_drawn(draw->ticket, true)->sequence, 2);
  EXPECT_FALSE(flow.next()) << "nothing is left to draw";
}

TEST(StreamFlow, a_rectangle_does_not_stand_for_a_change_of_the_whole_surface) {
  FlowControl flow = ready(2);
  flow.on_camera(1, camera_at(1), false);
  settle(flow);
  flow.on_change(box_at(1), 1);
  const auto draw = flow.next();
  flow.on_change_everywhere(2);
  flow.on_change(box_at(3), 3);
  EXPECT_TRUE(flow.on_begun(draw->ticket).empty());
  EXPECT_EQ(flow.on_drawn(draw->ticket, true)->sequence, 1);
  const auto whole = flow.next();
  ASSERT_TRUE(whole);
  EXPECT_FALSE(whole->changed);
  EXPECT_EQ(whole->sequence, 3);
}

TEST(StreamFlow, a_picture_of_the_past_takes_in_no_edit) {
  FlowControl flow = ready(2);
  flow.on_camera(1, camera_at(1), false);
  settle(flow);
  flow.on_past(5);
  flow.on_style();
  const auto past = flow.next();
  ASSERT_TRUE(past);
  flow.on_past({});  // returns to the newest state while the picture of the past waits
  flow.on_change_everywhere(9);
  EXPECT_TRUE(flow.on_begun(past->ticket).empty());
  EXPECT_EQ(flow.on_drawn(past->ticket, true)->sequence, 5);
  const auto newest = flow.next();
  ASSERT_TRUE(newest);
  EXPECT_FALSE(newest->changed);
  EXPECT_EQ(newest->sequence, 9);
}

TEST(StreamFlow, very_many_boxes_become_few_that_cover_them_all) {
  FlowControl flow = ready(1);
  flow.on_camera(1, camera_at(1), false);
  settle(flow);
  for (int i = 0; i < 1000; ++i) flow.on_change(box_at(float(i)), i);
  const auto draw = flow.next();
  ASSERT_TRUE(draw && draw->changed);
  EXPECT_EQ(draw->changed->size(), FlowControl::kMaxBoxes);
  for (int i = 0; i < 1000; ++i)
    EXPECT_TRUE(std::any_of(draw->changed->begin(), draw->changed->end(), [&](const auto& box) {
      return glm::min(box.min, box_at(float(i)).min) == box.min &&
             glm::max(box.max, box_at(float(i)).max) == box.max;
    })) << i;
}

TEST(StreamFlow, a_still_frame_follows_a_moving_one_once_it_is_quiet) {
  FlowControl flow = ready(2);
  flow.on_camera(1, camera_at(1), true);
  EXPECT_TRUE(flow.wants_quiet_timer());
  const auto moving = flow.next();
  ASSERT_TRUE(moving);
  EXPECT_EQ(moving->quality, Quality::moving);
  EXPECT_FALSE(flow.on_drawn(moving->ticket, true)->still);
  EXPECT_FALSE(flow.next());
  flow.on_quiet();
  const auto still = flow.next();
  ASSERT_TRUE(still);
  EXPECT_EQ(still->quality, Quality::still);
  EXPECT_FALSE(still->changed) << "the whole picture";
  EXPECT_TRUE(flow.on_drawn(still->ticket, true)->still);
  EXPECT_FALSE(flow.next());
  EXPECT_FALSE(flow.wants_quiet_timer());
}

TEST(StreamFlow, a_message_that_the_camera_stands_still_gives_the_still_frame_at_once) {
  FlowControl flow = ready(2);
  flow.on_camera(1, camera_at(1), true);
  settle(flow);
  flow.on_camera(2, camera_at(1), false);  // the same camera position
  const auto still = flow.next();
  ASSERT_TRUE(still);
  EXPECT_EQ(still->quality, Quality::still);
  EXPECT_EQ(still->camera_seq, 2u);
}

TEST(StreamFlow, quiet_during_a_moving_draw_still_leads_to_a_still_frame) {
  FlowControl flow = ready(3);
  flow.on_camera(1, camera_at(1), true);
  const auto moving = flow.next();
  flow.on_quiet();
  EXPECT_FALSE(flow.next());
  flow.on_drawn(moving->ticket, true);
  const auto still = flow.next();
  ASSERT_TRUE(still);
  EXPECT_EQ(still->quality, Quality::still);
}

TEST(StreamFlow,
     a_camera_that_waited_for_credit_until_it_was_quiet_is_drawn_once_and_at_full_quality) {
  FlowControl flow = ready(1);
  flow.on_camera(1, camera_at(1), true);
  flow.on_drawn(flow.next()->ticket, true);
  flow.on_camera(2, camera_at(2), true);
  flow.on_quiet();
  EXPECT_FALSE(flow.next());
  flow.on_ack(1);
  const auto draw = flow.next();
  ASSERT_TRUE(draw);
  EXPECT_EQ(draw->quality, Quality::still);
  flow.on_ack(flow.on_drawn(draw->ticket, true)->frame);
  EXPECT_FALSE(flow.next());
}

TEST(StreamFlow, a_superseded_draw_gives_its_changes_back) {
  FlowControl flow = ready(2);
  flow.on_camera(1, camera_at(1), false);
  settle(flow);
  flow.on_change(box_at(1), 1);
  const auto lost = flow.next();
  flow.on_change(box_at(2), 2);
  EXPECT_TRUE(flow.on_failed(lost->ticket));
  const auto again = flow.next();
  ASSERT_TRUE(again && again->changed);
  EXPECT_EQ(again->changed->size(), 2u);
  EXPECT_EQ(again->sequence, 2);
  EXPECT_TRUE(flow.on_failed(again->ticket));
  flow.on_style();
  const auto everything = flow.next();
  ASSERT_TRUE(everything);
  EXPECT_FALSE(everything->changed);
  EXPECT_TRUE(flow.on_failed(everything->ticket));
  EXPECT_FALSE(flow.next()->changed) << "a failed full picture stays a full picture";
}

TEST(StreamFlow, an_empty_picture_takes_no_number_and_no_credit) {
  FlowControl flow = ready(1);
  flow.on_camera(1, camera_at(1), false);
  settle(flow);
  for (int i = 0; i < 5; ++i) {
    flow.on_change(box_at(1), i);
    const auto draw = flow.next();
    ASSERT_TRUE(draw);
    EXPECT_FALSE(flow.on_drawn(draw->ticket, false));
  }
  EXPECT_EQ(flow.last_frame(), 1u);
}

TEST(StreamFlow, after_a_reset_old_answers_are_void_and_everything_is_drawn_anew) {
  FlowControl flow = ready(2);
  flow.on_camera(1, camera_at(1), false);
  settle(flow);
  flow.on_change(box_at(1), 5);
  const auto old = flow.next();
  flow.on_reset();
  EXPECT_FALSE(flow.next());
  EXPECT_FALSE(flow.on_failed(old->ticket));
  EXPECT_FALSE(flow.on_drawn(old->ticket, true));
  flow.on_ready();
  const auto draw = flow.next();
  ASSERT_TRUE(draw);
  EXPECT_FALSE(draw->changed);
  EXPECT_EQ(draw->sequence, 5);
  EXPECT_FALSE(flow.on_drawn(old->ticket, true)) << "an answer that comes late";
  EXPECT_TRUE(flow.on_drawn(draw->ticket, true));
}

TEST(StreamFlow,
     a_change_of_style_redraws_everything_and_the_scene_sequence_starts_where_it_is_told) {
  FlowControl flow(2, 41);
  flow.on_ready();
  flow.on_camera(1, camera_at(1), false);
  const auto first = flow.next();
  ASSERT_TRUE(first);
  EXPECT_EQ(first->sequence, 41);
  flow.on_drawn(first->ticket, true);
  EXPECT_FALSE(flow.next());
  flow.on_style();
  const auto draw = flow.next();
  ASSERT_TRUE(draw);
  EXPECT_FALSE(draw->changed);
}

TEST(StreamFlow, a_picture_at_rest_is_refined_once) {
  FlowControl flow(2, 0, 16);
  flow.on_ready();
  flow.on_camera(1, camera_at(1), false);
  EXPECT_TRUE(flow.wants_rest_timer());
  EXPECT_EQ(settle(flow), 1);
  flow.on_rest();
  const auto draw = flow.next();
  ASSERT_TRUE(draw);
  EXPECT_EQ(draw->samples, 16);
  EXPECT_FALSE(draw->changed);
  const auto number = flow.on_drawn(draw->ticket, true);
  ASSERT_TRUE(number);
  EXPECT_TRUE(number->still);
  flow.on_ack(number->frame);
  flow.on_rest();
  EXPECT_FALSE(flow.next());
  EXPECT_FALSE(flow.wants_rest_timer());
  flow.on_change(box_at(0), 1);
  EXPECT_TRUE(flow.wants_rest_timer());
  EXPECT_EQ(flow.next()->samples, 1);
}

TEST(StreamFlow, news_make_a_refinement_under_way_void_and_do_not_wait_for_it) {
  FlowControl flow(2, 0, 16);
  flow.on_ready();
  flow.on_camera(1, camera_at(1), false);
  settle(flow);
  flow.on_rest();
  const auto refinement = flow.next();
  ASSERT_TRUE(refinement);
  flow.on_change(box_at(3), 7);
  const auto draw = flow.next();
  ASSERT_TRUE(draw);
  EXPECT_EQ(draw->samples, 1);
  EXPECT_EQ(draw->changed, std::vector<Box>{box_at(3)});
  EXPECT_FALSE(flow.on_drawn(refinement->ticket, true));
  EXPECT_FALSE(flow.on_not_refined(refinement->ticket, true));
  EXPECT_TRUE(flow.on_drawn(draw->ticket, true));
}

TEST(StreamFlow, a_moving_camera_and_changes_go_before_the_refinement) {
  FlowControl flow(8, 0, 4);
  flow.on_ready();
  flow.on_camera(1, camera_at(1), true);
  flow.on_rest();
  auto draw = flow.next();
  ASSERT_TRUE(draw);
  EXPECT_EQ(draw->samples, 1);
  flow.on_drawn(draw->ticket, true);
  flow.on_rest();
  EXPECT_FALSE(flow.next()) << "the camera still moves";
  flow.on_quiet();
  draw = flow.next();
  ASSERT_TRUE(draw);
  EXPECT_EQ(draw->samples, 1) << "the picture of full quality";
  flow.on_drawn(draw->ticket, true);
  EXPECT_FALSE(flow.next()) << "the client does not have all frames";
  flow.on_ack(flow.last_frame());
  draw = flow.next();
  ASSERT_TRUE(draw);
  EXPECT_EQ(draw->samples, 4);
}

TEST(StreamFlow, a_refinement_that_was_not_drawn_is_tried_again_only_as_told) {
  FlowControl flow(2, 0, 4);
  flow.on_ready();
  flow.on_camera(1, camera_at(1), false);
  settle(flow);
  flow.on_rest();
  auto draw = flow.next();
  EXPECT_TRUE(flow.on_not_refined(draw->ticket, true));
  EXPECT_FALSE(flow.next());
  EXPECT_TRUE(flow.wants_rest_timer());
  flow.on_rest();
  draw = flow.next();
  ASSERT_TRUE(draw);
  EXPECT_TRUE(flow.on_not_refined(draw->ticket, false));
  flow.on_rest();
  EXPECT_FALSE(flow.next());
  EXPECT_FALSE(flow.wants_rest_timer());
  flow.on_style();
  EXPECT_EQ(settle(flow), 1);
  flow.on_rest();
  EXPECT_EQ(flow.next()->samples, 4);
}

// A model of a client checks the guarantees under any order of events. At the end, the screen must
// show the newest camera with every edit, at full quality. The number of unacknowledged frames must
// never exceed the window.
TEST(StreamFlow, in_any_order_of_events_nothing_is_lost_and_the_last_picture_is_complete) {
  for (unsigned seed = 0; seed < 300; ++seed) {
    std::mt19937 random(seed);
    auto roll = [&](int n) { return static_cast<int>(random() % unsigned(n)); };
    const int window = 1 + roll(3);
    FlowControl flow = ready(window);
    std::optional<FlowControl::Draw> out;
    std::set<int> unseen;      // edits that no sent frame shows
    std::set<int> in_out;      // unseen edits that precede the draw
    std::set<int> everywhere;  // edits of the whole surface, which no rectangle shows
    std::uint64_t sent = 0, acked = 0, camera_seq = 0;
    Camera newest = camera_at(0), shown;
    bool shown_still = false;
    int edit = 1;

    auto draw_done = [&](int what) {
      if (what == 0) {
        ASSERT_TRUE(roll(2) == 0 ? flow.on_refused(out->ticket) : flow.on_failed(out->ticket));
      } else {
        const auto number = flow.on_drawn(out->ticket, true);
        ASSERT_TRUE(number);
        ASSERT_EQ(number->frame, ++sent);
        for (int one : in_out) {
          const bool covered =
              !out->changed ||
              (!everywhere.contains(one) &&
               std::any_of(out->changed->begin(), out->changed->end(), [&](const Box& box) {
                 return box.min.x <= float(one) && box.max.x >= float(one + 1);
               }));
          if (covered) unseen.erase(one);
        }
        if (!out->changed) {
          shown = out->camera;
          shown_still = out->quality == Quality::still;
        } else {
          ASSERT_EQ(out->camera, shown) << "parts fit only the picture they are parts of";
        }
        ASSERT_EQ(number->still, shown_still);
        ASSERT_TRUE(unseen.empty() || *unseen.begin() > number->sequence)
            << "a frame shows every edit up to its sequence";
      }
      out.reset();
    };
    auto start = [&] {
      if (auto next = flow.next()) {
        ASSERT_FALSE(out) << "one draw at a time";
        ASSERT_LT(sent - acked, std::uint64_t(window));
        out = next;
        in_out = unseen;
      }
    };

    for (int step = 0; step < 200; ++step) {
      switch (roll(11)) {
        case 0:
          newest = camera_at(roll(4));
          flow.on_camera(++camera_seq, newest, true);
          break;
        case 1:
          newest = camera_at(roll(4));
          flow.on_camera(++camera_seq, newest, false);
          break;
        case 2:
          unseen.insert(edit);
          flow.on_change(box_at(float(edit)), edit);
          ++edit;
          break;
        case 3:
          if (out) draw_done(roll(4));
          break;
        case 4:
          if (acked < sent) flow.on_ack(++acked);
          break;
        case 5: flow.on_quiet(); break;
        case 6:
          if (!out) break;
          for (const Box& late : flow.on_begun(out->ticket))
            if (out->changed) out->changed->push_back(late);
          in_out = unseen;
          break;
        case 7:
          unseen.insert(edit);
          everywhere.insert(edit);
          flow.on_change_everywhere(edit);
          ++edit;
          break;
        case 8:
          if (roll(4) == 0) flow.on_style();
          break;
        default: break;
      }
      start();
      if (HasFatalFailure()) return;
    }
    // A rejected draw waits for a change.
    unseen.insert(edit);
    flow.on_change(box_at(float(edit)), edit);
    flow.on_camera(++camera_seq, newest, true);
    flow.on_quiet();
    for (int i = 0; i < 20; ++i) {
      if (out) draw_done(1);
      flow.on_ack(acked = sent);
      start();
      if (HasFatalFailure()) return;
    }
    EXPECT_FALSE(out) << "it comes to rest";
    EXPECT_TRUE(unseen.empty()) << "seed " << seed << ": " << unseen.size()
                                << " edits were never shown";
    EXPECT_EQ(shown, newest);
    EXPECT_TRUE(shown_still);
  }
}

}  // namespace
}  // namespace strata::stream
