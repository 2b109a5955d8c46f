#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <list>
#include <mutex>
#include <optional>
#include <thread>

#include "core/error.h"

namespace strata::render {

// What a job's step tells the GPU thread. A step takes a few milliseconds at most; long work is
// many steps.
enum class Step {
  more,     // call again
  yield,    // call again, after a step of the lanes behind: a long job whose own lane waits for it
  waiting,  // for the GPU: let others run, then call again
  done,
};

// Work for the GPU thread. Exactly one of these ends it: a step that returns `done`, or `abort`.
struct Job {
  std::function<Step()> step;
  std::function<void(const Error&)> abort;
};

enum class Lane {
  ordered,  // edits and layer changes: one after the other, first of all
  // uploads of models, surface maps and layers that are opened: one after the other, last of all
  background,
};

// The thread that owns the GPU. Ordered jobs go before frames, frames before background; a waiting
// job lets the next kind run meanwhile, but nothing overtakes it in its own lane. Frames wait while
// an ordered job can go on, unless it yields, or ordered jobs have been at it for a while: then
// both have the same time, so that a flood of edits is seen while it lasts.
class GpuThread {
 public:
  struct Hooks {
    std::function<Result<void>()> start;             // makes the context; its error ends `start`
    std::function<void()> stop;                      // destroys it
    std::function<bool()> lost;                      // asked before each step
    std::function<Result<void>()> recover;           // after a loss: all jobs were aborted
    std::function<std::optional<Job>()> next_frame;  // takes a waiting frame, if any may start
    // the same, if it should go before those under way
    std::function<std::optional<Job>()> next_part;
    std::function<void(const Error&)> abort_frames;  // answers those still waiting
  };

  explicit GpuThread(std::size_t capacity) : capacity_(capacity) {}
  ~GpuThread() { stop(); }
  GpuThread(const GpuThread&) = delete;
  GpuThread& operator=(const GpuThread&) = delete;

  Result<void> start(Hooks hooks);
  // Aborts what waits and joins. Called by the owner, not on the GPU thread.
  void stop();

  // False when the lane is full (unless `always`) or the thread has stopped: the caller answers.
  // `always` is for removals, one at most for each handle that was given out, and for the one who
  // waits until a lane is done.
  bool post(Lane lane, Job job, bool always = false);
  // Runs `reply` on the GPU thread before any other work; on this thread when it has stopped.
  // Replies have no capacity of their own: what waits is one for each request that was refused or
  // replaced during a step.
  void post_reply(std::function<void()> reply);
  void wake();  // a frame was queued
  bool ready() const { return !broken_; }

 private:
  using Clock = std::chrono::steady_clock;

  void run();
  bool run_some();  // false when there was nothing that could go on
  // The step of the lane's first job; nothing where the lane is empty.
  std::optional<Step> step_lane(Lane lane);
  bool step_frames();
  bool step_behind_edits();
  void run_replies();
  void recover();
  void abort_all(const Error& problem);
  std::deque<Job>& queue(Lane lane) { return lane == Lane::ordered ? ordered_ : background_; }

  const std::size_t capacity_;
  Hooks hooks_;
  std::thread thread_;
  std::mutex mutex_;  // guards what follows, up to the blank line
  std::condition_variable changed_;
  std::deque<Job> ordered_, background_;
  std::deque<std::function<void()>> replies_;
  bool frame_queued_ = false;
  bool stopping_ = false;
  bool stopped_ = true;

  // Of the GPU thread alone.
  std::optional<Job> current_[2];
  std::list<Job> frames_;
  // ordered jobs ran for so much longer than frames since frames last had nothing to do
  Clock::duration ahead_{};
  // a lost context that could not be replaced yet; others may read
  std::atomic<bool> broken_ = false;
  Clock::time_point next_recovery_{};
};

}  // namespace strata::render
