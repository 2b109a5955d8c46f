#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <mutex>
#include <thread>

#include "render/thread/gpu_thread.h"
#include "support/gl_scene.h"

namespace strata::test {
namespace {

using render::GpuThread;
using render::Job;
using render::Lane;
using render::Step;

// Blocks the first step of the thread until the gate is opened, so a test can fill the lanes before
// any other step.
struct Gate {
  std::promise<void> open, reached;
  std::shared_future<void> opened{open.get_future()};
  Job job() {
    return {[this] {
              reached.set_value();
              opened.wait();
              return Step::done;
            },
            [](const Error&) {}};
  }
};

class Lanes : public testing::Test {
 protected:
  void start(std::size_t capacity = 16) {
    thread_.emplace(capacity);
    GpuThread::Hooks hooks;
    hooks.start = []() -> Result<void> { return {}; };
    hooks.stop = [] {};
    hooks.lost = [this] { return lost_.exchange(false); };
    hooks.recover = [this]() -> Result<void> {
      if (broken_) return fail(ErrorCode::gpu_lost, "GPU lost", "No driver.");
      note("recovered");
      return {};
    };
    hooks.next_frame = [this]() -> std::optional<Job> {
      std::lock_guard lock(mutex_);
      if (frames_.empty()) return std::nullopt;
      Job job = std::move(frames_.front());
      frames_.pop_front();
      return job;
    };
    hooks.next_part = [this]() -> std::optional<Job> {
      std::lock_guard lock(mutex_);
      return std::exchange(part_, std::nullopt);
    };
    hooks.abort_frames = [](const Error&) {};
    ASSERT_TRUE(thread_->start(std::move(hooks)));
  }
  // Returns when the thread is blocked. Jobs that are posted after that wait together.
  void hold_at(Gate& gate) {
    ASSERT_TRUE(thread_->post(Lane::ordered, gate.job()));
    gate.reached.get_future().wait();
  }
  void note(const std::string& what) {
    std::lock_guard lock(mutex_);
    log_.push_back(what);
  }
  bool was_noted(const std::string& what) {
    std::lock_guard lock(mutex_);
    return std::find(log_.begin(), log_.end(), what) != log_.end();
  }
  Job noted(const std::string& name, int steps = 1) {
    return {[this, name, left = std::make_shared<int>(steps)] {
              note(name);
              return --*left > 0 ? Step::more : Step::done;
            },
            [this, name](const Error& problem) {
              note(name + " " + std::string(strata::name(problem.code)) + " " + problem.title);
            }};
  }
  std::vector<std::string> finish() {
    std::promise<void> done;
    EXPECT_TRUE(thread_->post(Lane::background, {[&] {
                                                   done.set_value();
                                                   return Step::done;
                                                 },
                                                 [&](const Error&) { done.set_value(); }}));
    done.get_future().wait();
    std::lock_guard lock(mutex_);
    return log_;
  }
  std::mutex mutex_;
  std::vector<std::string> log_;
  std::deque<Job> frames_;
  std::optional<Job> part_;
  std::atomic<bool> lost_{false}, broken_{false};
  std::optional<GpuThread> thread_;
};

TEST_F(Lanes, edits_go_before_frames_and_frames_before_background) {
  start();
  Gate gate;
  hold_at(gate);
  thread_->post(Lane::background, noted("background", 2));
  {
    std::lock_guard lock(mutex_);
    frames_.push_back(noted("frame"));
  }
  thread_->wake();
  thread_->post(Lane::ordered, noted("first edit"));
  thread_->post(Lane::ordered, noted("second edit", 2));
  gate.open.set_value();
  EXPECT_EQ(finish(), (std::vector<std::string>{"first edit", "second edit", "second edit", "frame",
                                                "background", "background"}));
}

TEST_F(Lanes, an_edit_runs_between_the_slices_of_a_long_background_job) {
  start();
  Gate gate;
  hold_at(gate);
  thread_->post(Lane::background, {[this, left = std::make_shared<int>(3)] {
                                     note("slice");
                                     if (*left == 3) {
                                       EXPECT_TRUE(thread_->post(Lane::ordered, noted("edit")));
                                     }
                                     return --*left > 0 ? Step::more : Step::done;
                                   },
                                   [](const Error&) {}});
  gate.open.set_value();
  EXPECT_EQ(finish(), (std::vector<std::string>{"slice", "edit", "slice", "slice"}));
}

TEST_F(Lanes, nothing_overtakes_an_edit_that_waits_for_the_gpu_but_a_frame) {
  start();
  Gate gate;
  hold_at(gate);
  auto frame_ran = std::make_shared<bool>(false);
  thread_->post(Lane::ordered, {[this, frame_ran] {
                                  if (!*frame_ran) return Step::waiting;
                                  note("waiting edit");
                                  return Step::done;
                                },
                                [](const Error&) {}});
  thread_->post(Lane::ordered, noted("next edit"));
  {
    std::lock_guard lock(mutex_);
    frames_.push_back({[this, frame_ran] {
                         note("frame");
                         *frame_ran = true;
                         return Step::done;
                       },
                       [](const Error&) {}});
  }
  gate.open.set_value();
  EXPECT_EQ(finish(), (std::vector<std::string>{"frame", "waiting edit", "next edit"}));
}

TEST_F(Lanes, an_edit_that_yields_shares_the_gpu_with_frames_and_uploads_but_not_with_other_edits) {
  start();
  Gate gate;
  hold_at(gate);
  thread_->post(Lane::ordered, {[this, left = std::make_shared<int>(4)] {
                                  note("slice");
                                  return --*left > 0 ? Step::yield : Step::done;
                                },
                                [](const Error&) {}});
  thread_->post(Lane::ordered, noted("next edit"));
  thread_->post(Lane::background, noted("upload"));
  {
    std::lock_guard lock(mutex_);
    frames_.push_back(noted("frame"));
  }
  gate.open.set_value();
  // One step takes the frame from the queue, and the next step draws it.
  EXPECT_EQ(finish(), (std::vector<std::string>{"slice", "slice", "frame", "slice", "upload",
                                                "slice", "next edit"}));
}

TEST_F(Lanes, a_small_frame_whose_turn_it_is_goes_between_the_slices_of_a_long_one) {
  start();
  Gate gate;
  hold_at(gate);
  {
    std::lock_guard lock(mutex_);
    frames_.push_back({[this, left = std::make_shared<int>(3)] {
                         note("slice");
                         if (*left == 3) {
                           std::lock_guard both(mutex_);
                           frames_.push_back(noted("next frame"));
                           part_ = noted("part", 2);
                         }
                         return --*left > 0 ? Step::more : Step::done;
                       },
                       [](const Error&) {}});
  }
  gate.open.set_value();
  EXPECT_EQ(finish(),
            (std::vector<std::string>{"slice", "part", "part", "slice", "slice", "next frame"}));
}

TEST_F(Lanes, a_flood_of_edits_lets_frames_through) {
  start();
  auto frame_ran = std::make_shared<bool>(false);
  thread_->post(Lane::ordered, {[frame_ran] { return *frame_ran ? Step::done : Step::more; },
                                [](const Error&) {}});
  {
    std::lock_guard lock(mutex_);
    frames_.push_back({[frame_ran] {
                         *frame_ran = true;
                         return Step::done;
                       },
                       [](const Error&) {}});
  }
  finish();  // would not end if the frame waited for the edit
  EXPECT_TRUE(*frame_ran);
}

TEST_F(Lanes, a_full_lane_refuses_but_not_what_must_not_be_lost) {
  start(2);
  Gate gate;
  std::promise<void> running;
  thread_->post(Lane::ordered, {[&] {
                                  running.set_value();
                                  gate.opened.wait();
                                  return Step::done;
                                },
                                [](const Error&) {}});
  running.get_future().wait();
  EXPECT_TRUE(thread_->post(Lane::ordered, noted("a")));
  EXPECT_TRUE(thread_->post(Lane::ordered, noted("b")));
  EXPECT_FALSE(thread_->post(Lane::ordered, noted("c")));
  EXPECT_TRUE(thread_->post(Lane::ordered, noted("removal"), true));
  gate.open.set_value();
  EXPECT_EQ(finish(), (std::vector<std::string>{"a", "b", "removal"}));
}

TEST_F(Lanes, a_lost_context_answers_all_that_waits_and_goes_on) {
  start();
  Gate gate;
  hold_at(gate);
  thread_->post(Lane::ordered, noted("edit"));
  thread_->post(Lane::background, noted("upload"));
  lost_ = true;
  gate.open.set_value();
  while (!was_noted("recovered")) std::this_thread::yield();
  thread_->post(Lane::ordered, noted("after"));
  const auto log = finish();
  EXPECT_EQ(log, (std::vector<std::string>{"edit gpu_lost GPU lost", "upload gpu_lost GPU lost",
                                           "recovered", "after"}));
}

TEST_F(Lanes, the_thread_is_not_ready_while_a_lost_context_cannot_be_replaced) {
  start();
  EXPECT_TRUE(thread_->ready());
  broken_ = true;
  lost_ = true;
  thread_->wake();
  while (thread_->ready()) std::this_thread::yield();
  thread_->post(Lane::ordered, noted("edit"));
  EXPECT_EQ(finish(), (std::vector<std::string>{"edit gpu_lost GPU lost"}));
  broken_ = false;
  while (!thread_->ready()) std::this_thread::yield();
  EXPECT_EQ(finish().back(), "recovered");
}

TEST_F(Lanes, stopping_answers_what_waits) {
  start();
  Gate gate;
  hold_at(gate);
  thread_->post(Lane::ordered, noted("edit"));
  std::thread stopper([&] { thread_->stop(); });
  std::this_thread::yield();
  gate.open.set_value();
  stopper.join();
  EXPECT_FALSE(thread_->post(Lane::ordered, noted("late")));
  std::lock_guard lock(mutex_);
  // The edit may run before the stop takes effect, but its callback must run exactly once.
  ASSERT_EQ(log_.size(), 1u);
  EXPECT_TRUE(log_[0] == "edit" || log_[0] == "edit unavailable Renderer stopped");
}

TEST(Frames, many_superseded_requests_of_one_view_are_all_answered) {
  TestRenderer renderer;
  const auto view = renderer.add_view(renderer.add(make_scene(bumpy_sphere(60), 256)));
  std::atomic<int> drawn{0}, superseded{0}, other{0};
  constexpr int kRequests = 50;
  for (int i = 0; i < kRequests; ++i) {
    render::FrameRequest request;
    request.view = view;
    request.camera = perspective_camera({1.2 + 0.01 * i, 1, 2.4}, {0, 0, 0}, 320, 240);
    request.width = 320, request.height = 240;
    renderer->draw(request, [&](const Result<render::SharedFrame>& frame) {
      if (frame)
        ++drawn;
      else if (frame.error().code == ErrorCode::superseded)
        ++superseded;
      else
        ++other;
    });
  }
  while (drawn + superseded + other < kRequests) std::this_thread::yield();
  EXPECT_EQ(other, 0);
  EXPECT_GE(drawn, 1);
}

TEST(LostContext, pending_work_is_answered_and_the_renderer_works_again_with_new_handles) {
  TestRenderer renderer;
  const auto scene = make_scene(flat_square(), 256);
  const auto model = renderer.add(scene);
  const auto layer = renderer.add_layer(model, ValueType::u8, 256);
  const auto view = renderer.add_view(model);
  const auto camera = orthographic_camera({0, 0, 2}, {0, 0, 0}, 200, 200, 0.5);
  std::promise<void> notified;
  renderer->on_context_lost([&] { notified.set_value(); });

  // The thread is blocked while jobs are queued after the loss of the context.
  std::atomic<int> lost{0};
  constexpr int kStrokes = 5;
  std::thread holder([&] {
    renderer->run_on_gpu_thread_for_test([&] {
      renderer->lose_context_for_test();
      for (int i = 0; i < kStrokes; ++i) {
        renderer->paint(layer, dab(camera, 100, 100, 20),
                        [&](Result<render::StrokeOutcome> outcome) {
                          if (!outcome && outcome.error().code == ErrorCode::gpu_lost) ++lost;
                        });
      }
    });
  });
  holder.join();
  notified.get_future().wait();
  EXPECT_EQ(lost, kStrokes);

  const auto old_layer = await<render::StrokeOutcome>(
      [&](auto done) { renderer->paint(layer, dab(camera, 100, 100, 20), std::move(done)); });
  ASSERT_FALSE(old_layer);
  EXPECT_EQ(old_layer.error().code, ErrorCode::not_found);
  render::FrameRequest request;
  request.view = view;
  request.camera = camera;
  request.width = request.height = 200;
  EXPECT_FALSE(
      await<render::SharedFrame>([&](auto done) { renderer->draw(request, std::move(done)); }));
  EXPECT_EQ(renderer->layer_bytes_used(layer), 0u);

  const auto new_model = renderer.add(scene);
  EXPECT_NE(new_model, model);
  const auto new_layer = renderer.add_layer(new_model, ValueType::u8, 256);
  EXPECT_FALSE(renderer.paint(new_layer, dab(camera, 100, 100, 20)).tiles.empty());
  request.view = renderer.add_view(new_model);
  EXPECT_EQ(renderer.draw(request).rects.at(0).width, 200);
}

TEST(Order, strokes_are_answered_in_the_order_they_were_given) {
  TestRenderer renderer;
  const auto layer =
      renderer.add_layer(renderer.add(make_scene(flat_square(), 256)), ValueType::u8, 256);
  const auto camera = orthographic_camera({0, 0, 2}, {0, 0, 0}, 200, 200, 0.5);
  std::vector<std::uint32_t> order;
  std::promise<void> all;
  for (std::uint32_t i = 0; i < 40; ++i) {
    renderer->paint(layer, dab(camera, 100, 100, 30, i),
                    [&, i](Result<render::StrokeOutcome> outcome) {
                      ASSERT_TRUE(outcome);
                      order.push_back(i);
                      // `after` is the result of this stroke and must not depend on later strokes.
                      for (const auto& tile : outcome->tiles) {
                        for (int t = 0; t < kTexelsPerTile; ++t) {
                          ASSERT_TRUE(!tile.written.test(t) || tile.after.bits(t) == i);
                        }
                      }
                      if (i == 39) all.set_value();
                    });
  }
  all.get_future().wait();
  for (std::uint32_t i = 0; i < 40; ++i) EXPECT_EQ(order[i], i);
}

TEST(Start, a_missing_shader_folder_is_told) {
  render::RendererOptions options;
  options.shader_dir = "/nonexistent/shaders";
  const auto renderer = render::Renderer::start(options);
  ASSERT_FALSE(renderer);
  EXPECT_NE(renderer.error().detail.find("/nonexistent/shaders"), std::string::npos);
}

TEST(Start, the_driver_is_described) {
  TestRenderer renderer;
  const auto info = renderer->info();
  EXPECT_FALSE(info.renderer.empty());
  EXPECT_GE(info.max_texture_size, 16384);
  EXPECT_GE(info.max_image_units, 8);
  EXPECT_GE(info.max_texture_units, 16);
}

}  // namespace
}  // namespace strata::test
