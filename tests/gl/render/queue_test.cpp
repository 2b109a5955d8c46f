#include <gtest/gtest.h>

#include <deque>
#include <map>

#include "render/thread/frame_queue.h"
#include "render/thread/refinements.h"

namespace strata::render {
namespace {

using Box = FrameRequest::Box;
using Boxes = std::vector<Box>;

const Box kBox{{0, 0, 0}, {1, 1, 1}}, kOther{{2, 2, 2}, {3, 3, 3}};

using Answer = std::optional<ErrorCode>;
constexpr Answer kDrawn = std::nullopt;

// Tests of the order in which frames are drawn. The results identify the requests.
class FrameTurns : public testing::Test {
 protected:
  FrameQueue::Pushed push(FrameQueue& queue, const FrameRequest& request, int number = 0) {
    return queue.push(request, [this, number](const Result<SharedFrame>& frame) {
      answers_[number] = frame ? kDrawn : Answer(frame.error().code);
    });
  }
  static FrameRequest whole(ViewHandle view, int width = 1) {
    FrameRequest request;
    request.view = view;
    request.width = width;
    return request;
  }
  static FrameRequest part(ViewHandle view, Boxes boxes = {kBox}, int width = 1) {
    FrameRequest request = whole(view, width);
    request.changed = std::move(boxes);
    return request;
  }
  static FrameRequest large(FrameRequest request) {
    request.large = true;
    return request;
  }
  static FrameRequest acting(FrameRequest request) {
    request.acting = true;
    return request;
  }
  static FrameRequest shared(FrameRequest request, ModelHandle model = 7) {
    request.model = model;
    return request;
  }
  // Takes the next task and returns its view.
  static ViewHandle draw(FrameQueue& queue, double took_ms = 1) {
    const auto task = queue.take();
    if (!task) return 0;
    queue.finished(*task, took_ms);
    return task->askers.front().view;
  }

  std::map<int, Answer> answers_;
};

TEST_F(FrameTurns, the_latest_request_of_a_view_wins_and_inherits_what_was_to_be_redrawn) {
  FrameQueue queue(8);
  EXPECT_FALSE(push(queue, part(1, {kBox}, 10), 1).displaced);
  const auto pushed = push(queue, part(1, {kOther}, 20), 2);
  ASSERT_TRUE(pushed.displaced);
  (*pushed.displaced)(fail(ErrorCode::superseded, "Superseded", ""));
  EXPECT_EQ(answers_, (std::map<int, Answer>{{1, ErrorCode::superseded}}));
  const auto taken = queue.take();
  ASSERT_TRUE(taken);
  EXPECT_EQ(taken->request.width, 20);
  EXPECT_EQ(*taken->request.changed, (Boxes{kOther, kBox}));
  // A request that replaces a request for the complete frame is also for the complete frame.
  queue.finished(*taken, 1);
  push(queue, whole(1, 10));
  push(queue, part(1, {kOther}, 20));
  EXPECT_FALSE(queue.take()->request.changed.has_value());
}

TEST_F(FrameTurns, a_view_whose_frame_failed_does_not_draw_the_same_frame_of_another_view) {
  FrameQueue queue(8);
  // View 1 was removed between its request and the call of `push`.
  queue.forget(1);
  push(queue, shared(whole(1)));
  const auto failed = queue.take();
  ASSERT_TRUE(failed);
  queue.finished(*failed, 1, false);
  push(queue, shared(whole(2)));
  const auto next = queue.take();
  ASSERT_TRUE(next);
  EXPECT_EQ(next->request.view, 2u);
  queue.finished(*next, 1);
  // After a success, the view draws it again for others.
  push(queue, shared(whole(3)));
  EXPECT_EQ(queue.take()->request.view, 2u);
}

TEST_F(FrameTurns, a_view_has_one_frame_under_way_and_one_that_waits_and_too_many_are_refused) {
  FrameQueue queue(2);
  push(queue, whole(1));
  push(queue, whole(2));
  EXPECT_FALSE(push(queue, whole(3)).accepted);
  const auto first = queue.take();
  EXPECT_EQ(first->request.view, 1u);
  push(queue, whole(1));
  EXPECT_EQ(queue.take()->request.view, 2u);
  EXPECT_FALSE(queue.take()) << "view 1 has a frame under way";
  queue.finished(*first, 1);
  EXPECT_EQ(queue.take()->request.view, 1u);
}

TEST_F(FrameTurns, turns_are_fair_by_what_drawing_took) {
  FrameQueue queue(8);
  std::map<ViewHandle, int> turns;
  push(queue, whole(1));
  push(queue, whole(2));
  for (int i = 0; i < 500; ++i) {
    const auto task = queue.take();
    const ViewHandle view = task->request.view;
    ++turns[view];
    queue.finished(*task, view == 1 ? 40 : 10);
    push(queue, whole(view));
  }
  EXPECT_NEAR(turns[2], 4.0 * turns[1], 8) << "each had the same milliseconds";
}

TEST_F(FrameTurns, who_only_looks_is_served_before_the_next_picture_of_who_turns_the_model) {
  FrameQueue queue(16);
  for (int i = 0; i < 5; ++i) {
    for (ViewHandle turning = 1; turning <= 4; ++turning) push(queue, whole(turning));
    for (int n = 0; n < 4; ++n) draw(queue, 50);
  }
  for (ViewHandle turning = 1; turning <= 4; ++turning) push(queue, whole(turning));
  push(queue, part(9));
  EXPECT_EQ(draw(queue, 1), 9u);
  // A view collects no credit while it requests nothing. After its first frame, it takes turns.
  int looked = 0;
  for (int i = 0; i < 20; ++i) {
    push(queue, part(9));
    if (draw(queue, 50) == 9)
      ++looked;
    else
      for (ViewHandle turning = 1; turning <= 4; ++turning) push(queue, whole(turning));
  }
  EXPECT_LE(looked, 6);
}

TEST_F(FrameTurns, only_a_rectangle_whose_turn_it_is_goes_before_a_picture_that_is_half_done) {
  FrameQueue queue(8);
  push(queue, whole(1));
  const auto drawn = queue.take();
  push(queue, whole(2));
  const auto half_done = [&](double ms) {
    return std::vector{FrameTask::Turn{false, drawn->turn.ms + ms}};
  };
  EXPECT_FALSE(queue.take_part(half_done(100))) << "a whole picture waits";
  push(queue, part(3));
  EXPECT_FALSE(queue.take_part(half_done(0))) << "no one was served more";
  const auto part = queue.take_part(half_done(5));
  ASSERT_TRUE(part);
  EXPECT_EQ(part->request.view, 3u);
}

TEST_F(FrameTurns, any_smaller_picture_whose_turn_it_is_goes_before_a_band_of_a_large_one) {
  FrameQueue queue(8);
  push(queue, large(whole(1)));
  const auto band = queue.take();
  ASSERT_TRUE(band);
  EXPECT_TRUE(band->turn.large);
  const auto half_done = [&](double ms) {
    return std::vector{FrameTask::Turn{false, band->turn.ms + ms, true}};
  };
  push(queue, large(whole(2)));
  EXPECT_FALSE(queue.take_part(half_done(5))) << "of large ones each is done when it has begun";
  push(queue, whole(3));
  EXPECT_FALSE(queue.take_part(half_done(0))) << "no one was served more";
  const auto small = queue.take_part(half_done(5));
  ASSERT_TRUE(small);
  EXPECT_EQ(small->request.view, 3u);
  // If a frame that is not large is also half done, rectangles wait as usual.
  push(queue, whole(4));
  EXPECT_FALSE(queue.take_part(
      std::vector{FrameTask::Turn{false, 100, false}, FrameTask::Turn{false, 100, true}}));
}

TEST_F(FrameTurns, bands_of_large_pictures_take_turns_with_live_views_and_leave_them_room) {
  FrameQueue queue(16);
  for (const ViewHandle view : {1, 2, 3}) push(queue, large(whole(view)));
  const auto first = queue.take(), second = queue.take();
  ASSERT_TRUE(first && second);
  EXPECT_FALSE(queue.take()) << "two bands are enough to keep the GPU at work";
  push(queue, whole(4));
  EXPECT_EQ(draw(queue), 4u);
  queue.finished(*first, 50);
  queue.finished(*second, 50);
  // Large frames of three views and constant requests of a fourth view: each view gets an equal
  // share of the time.
  std::map<ViewHandle, int> drawn;
  push(queue, large(whole(1)));
  push(queue, large(whole(2)));
  push(queue, whole(4));
  for (int i = 0; i < 120; ++i) {
    const auto task = queue.take();
    ASSERT_TRUE(task);
    const ViewHandle view = task->askers.front().view;
    drawn[view] += view == 4 ? 10 : 50;
    queue.finished(*task, view == 4 ? 10 : 50);
    push(queue, view == 4 ? whole(view) : large(whole(view)));
  }
  for (const ViewHandle view : {1, 2, 3}) EXPECT_NEAR(drawn[view], drawn[4], 110) << view;
}

TEST_F(FrameTurns, a_hundred_onlookers_and_one_who_acts_have_half_of_the_time_each) {
  FrameQueue queue(256);
  constexpr ViewHandle kActor = 500;
  const auto surface_image_on = [&](ViewHandle view) { push(queue, part(view)); };
  const auto act = [&] { push(queue, acting(part(kActor))); };
  for (ViewHandle view = 1; view <= 100; ++view) surface_image_on(view);
  for (int i = 0; i < 50; ++i) surface_image_on(draw(queue, 20));
  act();
  EXPECT_EQ(draw(queue, 20), kActor) << "who comes waits for one picture at most";
  std::map<ViewHandle, int> turns;
  for (int i = 0; i < 400; ++i) {
    act();
    const ViewHandle view = draw(queue, 20);
    ++turns[view];
    if (view != kActor) surface_image_on(view);
  }
  EXPECT_NEAR(turns[kActor], 200, 2);
  EXPECT_EQ(turns.size(), 101u) << "everybody sees something";
  for (const auto& [view, count] : turns) EXPECT_LE(count, view == kActor ? 202 : 3) << view;
  // Without active views, onlookers get the whole time. A view that becomes active later gets no
  // credit.
  for (int i = 0; i < 400; ++i) surface_image_on(draw(queue, 20));
  int acted = 0;
  for (int i = 0; i < 20; ++i) {
    act();
    const ViewHandle view = draw(queue, 20);
    view == kActor ? ++acted : (surface_image_on(view), 0);
  }
  EXPECT_NEAR(acted, 10, 1);
}

TEST_F(FrameTurns, a_rectangle_of_who_acts_goes_before_the_half_done_picture_of_an_onlooker) {
  FrameQueue queue(8);
  push(queue, whole(1));
  const auto drawn = queue.take();
  const std::vector half_done{FrameTask::Turn{false, drawn->turn.ms}};
  push(queue, part(2));
  EXPECT_FALSE(queue.take_part(half_done)) << "an onlooker as well";
  push(queue, acting(part(3)));
  const auto part_of_3 = queue.take_part(half_done);
  ASSERT_TRUE(part_of_3);
  EXPECT_EQ(part_of_3->request.view, 3u);
  queue.finished(*part_of_3, 10);
  push(queue, acting(part(3)));
  EXPECT_FALSE(queue.take_part(half_done)) << "that half has had its share";
}

TEST_F(FrameTurns, rectangles_do_not_use_up_the_time_of_whole_pictures_of_those_who_act) {
  FrameQueue queue(256);
  constexpr ViewHandle kTurning = 500, kPainting = 501;
  struct Drawing {
    FrameTask task;
    double busy_ms = 0;
  };
  std::deque<Drawing> under_way;  // urgent work is in front, as in GpuThread
  double turning_ms = 0, painting_ms = 0, onlookers_ms = 0;
  const auto surface_image_on = [&](ViewHandle view) { push(queue, part(view)); };
  for (ViewHandle view = 1; view <= 100; ++view) surface_image_on(view);
  for (int now_ms = 0; now_ms < 20'000; now_ms += 5) {
    // Newer requests always replace the waiting ones.
    push(queue, acting(whole(kTurning, now_ms + 1)));
    push(queue, acting(part(kPainting)));
    if (under_way.empty()) {
      under_way.push_back({*queue.take()});
    } else if (under_way.size() < 4) {
      std::vector<FrameTask::Turn> turns;
      for (const auto& [task, busy_ms] : under_way)
        turns.push_back({task.turn.acting, task.turn.ms + busy_ms});
      if (auto before = queue.take_part(turns)) under_way.push_front({std::move(*before)});
    }
    Drawing& drawing = under_way.front();
    const ViewHandle view = drawing.task.askers.front().view;
    (view == kTurning ? turning_ms : view == kPainting ? painting_ms : onlookers_ms) += 5;
    drawing.busy_ms += 5;
    if (drawing.busy_ms < (view == kTurning ? 60 : view == kPainting ? 10 : 30)) continue;
    queue.finished(drawing.task, drawing.busy_ms);
    under_way.pop_front();
    if (view < kTurning) surface_image_on(view);
  }
  EXPECT_NEAR(onlookers_ms, 10'000, 500);
  EXPECT_NEAR(turning_ms, 5'000, 500);
  EXPECT_NEAR(painting_ms, 5'000, 500);
}

TEST_F(FrameTurns, who_asks_anew_while_they_wait_keep_their_turn) {
  FrameQueue queue(8);
  push(queue, part(3));
  draw(queue, 5);
  push(queue, whole(1));
  const auto half_done = queue.take();
  push(queue, whole(2));
  push(queue, part(3));
  ASSERT_TRUE(queue.take_part(std::vector{FrameTask::Turn{false, half_done->turn.ms + 20}}));
  push(queue, part(4));
  push(queue, whole(2));
  EXPECT_EQ(draw(queue), 2u);
}

TEST_F(FrameTurns, who_ends_to_act_is_an_onlooker_like_others) {
  FrameQueue queue(8);
  for (int i = 0; i < 20; ++i) {
    push(queue, acting(whole(1)));
    draw(queue, 100);
  }
  push(queue, part(1));
  push(queue, part(2));
  EXPECT_EQ(draw(queue, 1), 1u) << "what it was served while it acted counts no more";
  EXPECT_EQ(draw(queue, 1), 2u);
}

TEST_F(FrameTurns, a_picture_that_one_of_its_askers_acts_in_is_theirs) {
  FrameQueue queue(8);
  push(queue, shared(part(1)));
  push(queue, part(2));
  push(queue, acting(shared(part(3))));
  auto task = queue.take();
  EXPECT_TRUE(task->turn.acting);
  EXPECT_EQ(task->askers.size(), 2u);
  queue.finished(*task, 0);
  // The active view now requests another frame, so only an onlooker still needs the first one.
  push(queue, shared(part(1)));
  push(queue, acting(shared(part(3))));
  push(queue, acting(whole(3, 5)));
  EXPECT_EQ(queue.take()->request.width, 5);
  EXPECT_FALSE(queue.take()->turn.acting);
}

TEST_F(FrameTurns, the_same_picture_of_several_views_is_drawn_once_by_the_view_that_has_it) {
  FrameQueue queue(8);
  push(queue, shared(whole(1)), 1);
  EXPECT_EQ(draw(queue), 1u);
  // After an edit, view 1 draws. The other views have no frame yet, so they wait for view 1.
  push(queue, shared(part(1)), 1);
  const auto first = queue.take();
  push(queue, shared(part(2)), 2);
  push(queue, shared(part(3, {kOther})), 3);
  EXPECT_FALSE(queue.take());
  queue.finished(*first, 1);
  const auto second = queue.take();
  ASSERT_TRUE(second);
  EXPECT_EQ(second->request.view, 1u);
  ASSERT_EQ(second->askers.size(), 2u);
  EXPECT_EQ(*second->request.changed, (Boxes{kBox, kOther}));
  for (const auto& asker : second->askers) asker.done(std::make_shared<const Frame>());
  EXPECT_EQ(answers_, (std::map<int, Answer>{{2, kDrawn}, {3, kDrawn}}));
  EXPECT_FALSE(queue.take());
}

TEST_F(FrameTurns, pictures_that_differ_in_anything_are_not_shared) {
  FrameQueue queue(64);
  const auto base = shared(part(1));
  std::vector<FrameRequest> others(9, base);
  others[0].model = 8;
  others[1].moving = true;
  others[2].height = 4;
  others[3].camera.view[3][0] = 1;
  others[4].style.layers = {{1, nullptr, 1}};
  others[5].style.images = {{1, 1}};
  others[6].style.features = std::make_shared<const std::vector<DrawnFeature>>();
  others[7].style.unit_mm = 1;
  others[8].changed.reset();  // a view that needs only a rectangle gets no whole frame
  push(queue, base);
  ViewHandle view = 1;
  for (auto& other : others) {
    other.view = ++view;
    push(queue, other);
  }
  auto not_reported = part(++view);
  push(queue, not_reported);
  for (ViewHandle i = 1; i <= view; ++i) EXPECT_EQ(queue.take()->askers.size(), 1u);
  EXPECT_FALSE(queue.take());
}

TEST_F(FrameTurns, five_hundred_onlookers_take_turns_in_the_order_of_their_waiting) {
  FrameQueue queue(1024);
  constexpr ViewHandle kOnlookers = 500, kPainter = 1000;
  std::vector<ViewHandle> order;
  for (ViewHandle view = 1; view <= kOnlookers; ++view) push(queue, part(view));
  for (ViewHandle round = 0; round < 2; ++round)
    for (ViewHandle i = 0; i < kOnlookers; ++i) {
      order.push_back(draw(queue, 5));
      push(queue, part(order.back()));
      // The painter needs less than half of the time, so nobody's frame precedes the painter's.
      if (i % 2 != 0) continue;
      push(queue, acting(part(kPainter)));
      ASSERT_EQ(draw(queue, 5), kPainter) << "round " << round << ", turn " << i;
    }
  for (std::size_t i = 0; i < order.size(); ++i)
    ASSERT_EQ(order[i], i % kOnlookers + 1) << "turn " << i;
}

TEST_F(FrameTurns, an_onlooker_who_begins_to_act_leaves_the_other_onlookers) {
  FrameQueue queue(64);
  for (ViewHandle view = 1; view <= 20; ++view) push(queue, part(view));
  draw(queue, 10);
  queue.view_acts(20);
  EXPECT_EQ(draw(queue, 10), 20u) << "it waited among the onlookers";
  EXPECT_EQ(draw(queue, 10), 2u);
  queue.view_acts(20);  // nothing of this view waits
  queue.view_acts(99);  // unknown
  EXPECT_EQ(draw(queue, 10), 3u);
  // A shared frame has the turn of its acting requester.
  push(queue, shared(part(30)));
  push(queue, shared(part(31)));
  queue.view_acts(31);
  const auto task = queue.take();
  ASSERT_TRUE(task);
  EXPECT_TRUE(task->turn.acting);
  EXPECT_EQ(task->askers.size(), 2u);
}

TEST_F(FrameTurns, a_frame_that_begins_shows_what_changed_while_it_waited) {
  FrameQueue queue(8);
  int asked = 0;
  const auto late = [&](Boxes boxes) {
    return [&asked, boxes = std::move(boxes)] {
      ++asked;
      return boxes;
    };
  };
  const auto ignore = [](const Result<SharedFrame>&) {};
  queue.push(shared(part(1)), ignore, late({kOther}));
  queue.push(shared(part(2)), ignore, late({kBox, kOther}));
  auto rectangle = queue.take();
  ASSERT_TRUE(rectangle);
  EXPECT_EQ(asked, 0);
  rectangle->add_late_changes();
  EXPECT_EQ(*rectangle->request.changed, (Boxes{kBox, kOther}));
  EXPECT_EQ(asked, 2) << "each view learns that its changes are shown";
  rectangle->add_late_changes();
  EXPECT_EQ(asked, 2) << "once for each frame";
  queue.push(whole(3), ignore, late({kBox}));
  auto whole_frame = queue.take();
  ASSERT_TRUE(whole_frame);
  whole_frame->add_late_changes();
  EXPECT_FALSE(whole_frame->request.changed);
  EXPECT_EQ(asked, 3);
}

TEST_F(FrameTurns, what_is_shared_costs_each_a_part) {
  FrameQueue queue(8);
  push(queue, shared(whole(1)));
  push(queue, shared(whole(2)));
  push(queue, whole(3, 5));
  draw(queue, 30);
  draw(queue, 20);
  push(queue, whole(3, 5));
  push(queue, whole(2));
  EXPECT_EQ(draw(queue), 2u) << "15 ms against 20";
}

TEST_F(FrameTurns, a_view_that_is_removed_draws_no_more_for_others) {
  FrameQueue queue(8);
  push(queue, shared(whole(1)));
  EXPECT_EQ(draw(queue), 1u);
  queue.forget(1);
  push(queue, shared(part(2)));
  EXPECT_EQ(queue.take()->request.view, 2u);
  // A request that is already waiting still gets its frame in its turn.
  push(queue, part(3));
  queue.forget(3);
  EXPECT_EQ(queue.take()->request.view, 3u);
}

TEST_F(FrameTurns, a_request_that_leaves_a_shared_picture_leaves_the_others_there) {
  FrameQueue queue(8);
  push(queue, shared(part(1)), 1);
  push(queue, shared(part(2)), 2);
  EXPECT_TRUE(push(queue, shared(part(1, {kOther}, 9)), 3).displaced);
  const auto left = queue.take();
  ASSERT_EQ(left->askers.size(), 1u);
  EXPECT_EQ(left->askers.front().view, 2u);
  EXPECT_EQ(queue.take()->request.width, 9);
  push(queue, whole(4));
  EXPECT_EQ(queue.take_all().size(), 1u);
  EXPECT_FALSE(queue.take());
}

// Refinements of views, and their results.
class RefinementTasks : public testing::Test {
 protected:
  using Answer = std::optional<ErrorCode>;
  std::shared_ptr<Refinements::Task> push(ViewHandle view, int width = 100) {
    FrameRequest request;
    request.view = view;
    request.model = 7;
    request.width = width;
    request.samples = 16;
    return refinements_.push(request, [this, view](const Result<SharedFrame>& frame) {
      answers_[view] = frame ? kDrawn : Answer(frame.error().code);
    });
  }
  Refinements refinements_;
  std::map<ViewHandle, Answer> answers_;
};

TEST_F(RefinementTasks, equal_pictures_that_wait_are_one_task) {
  const auto task = push(1);
  ASSERT_TRUE(task);
  EXPECT_FALSE(push(2));
  EXPECT_TRUE(push(3, 200)) << "another size";
  EXPECT_TRUE(refinements_.continues(*task));
  EXPECT_FALSE(push(4)) << "it was started, and nothing changed";
  refinements_.content_changed();
  EXPECT_TRUE(push(5)) << "a task that was started shows an older state";
  refinements_.answer(*task, std::make_shared<const Frame>());
  EXPECT_EQ(answers_, (std::map<ViewHandle, Answer>{{1, kDrawn}, {2, kDrawn}, {4, kDrawn}}));
  EXPECT_TRUE(push(6)) << "a task that is over answers nobody";
}

TEST_F(RefinementTasks, a_task_that_waits_shows_what_changed_before_it_starts) {
  const auto task = push(1);
  refinements_.content_changed();
  EXPECT_FALSE(push(2));
  EXPECT_TRUE(refinements_.continues(*task));
  EXPECT_FALSE(push(3));
}

TEST_F(RefinementTasks, news_of_one_view_do_not_end_the_refinement_of_others) {
  const auto task = push(1);
  push(2);
  push(3);
  EXPECT_TRUE(refinements_.continues(*task));
  refinements_.overtake(1);
  EXPECT_TRUE(refinements_.continues(*task));
  EXPECT_EQ(answers_, (std::map<ViewHandle, Answer>{{1, ErrorCode::superseded}}));
  refinements_.forget(3);
  EXPECT_TRUE(refinements_.continues(*task));
  EXPECT_EQ(answers_[3], ErrorCode::superseded);
  refinements_.answer(*task, std::make_shared<const Frame>());
  EXPECT_EQ(answers_[2], kDrawn);
}

TEST_F(RefinementTasks, a_refinement_that_nobody_waits_for_ends) {
  const auto task = push(1);
  refinements_.overtake(1);
  refinements_.overtake(2);  // this view has requested no refinement
  EXPECT_FALSE(refinements_.continues(*task));
  EXPECT_EQ(answers_[1], ErrorCode::superseded);
  EXPECT_TRUE(refinements_.continues(*push(1))) << "what it asks for afterwards is new";
}

}  // namespace
}  // namespace strata::render
