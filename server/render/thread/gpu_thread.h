#pragma once

#include <array>
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

// The result of a job's step. A step takes a few milliseconds at most; long work is divided into
// many steps.
enum class Step {
  more,     // call again
  yield,    // call again, after a step of the later lanes: a long job that delays its own lane
  waiting,  // for the GPU: run others, then call again
  done,
};

// Work for the GPU thread. It ends either by a step that returns `done`, or by `abort`.
struct Job {
  std::function<Step()> step;
  std::function<void(const Error&)> abort;
};

enum class Lane {
  ordered,  // edits and layer changes: one after the other, before all else
  // uploads of models, surface maps and opened layers: one after the other, after frames
  background,
  // refinements of pictures: one after the other, while nothing else is in progress
  idle,
};

// The thread that owns the GPU. Ordered jobs precede frames, frames precede background jobs. While
// a job waits, the next kind runs, but no job overtakes another in its lane. Frames wait while an
// ordered job can run, unless it yields, or ordered jobs have run for a while: then both get the
// same time, so that many edits are visible during their work.
class GpuThread {
 public:
  struct Hooks {
    std::function<Result<void>()> start;    // makes the context; its error is that of `start`
    std::function<void()> stop;             // destroys it
    std::function<bool()> lost;             // called before each step
    std::function<Result<void>()> recover;  // after a loss: all jobs were aborted
    std::function<std::optional<Job>()> next_frame;  // takes a waiting frame, if any may start
    // the same, if it should precede the frames in progress
    std::function<std::optional<Job>()> next_part;
    std::function<void(const Error&)> abort_frames;  // answers those still waiting
  };

  explicit GpuThread(std::size_t capacity) : capacity_(capacity) {}
  ~GpuThread() { stop(); }
  GpuThread(const GpuThread&) = delete;
  GpuThread& operator=(const GpuThread&) = delete;

  Result<void> start(Hooks hooks);
  // Aborts waiting jobs and joins. Called by the owner, not on the GPU thread.
  void stop();

  // False if the lane is full (unless `always`) or the thread has stopped: the caller answers.
  // `always` is for removals, at most one for each handle, and for a caller that waits for the end
  // of a lane.
  bool post(Lane lane, Job job, bool always = false);
  // Runs `reply` on the GPU thread before any other work; on the calling thread if it has stopped.
  // Replies have no limit of their own: at most one waits for each request that was refused or
  // replaced during a step.
  void post_reply(std::function<void()> reply);
  void wake();  // a frame was queued
  bool ready() const { return !broken_; }

 private:
  using Clock = std::chrono::steady_clock;

  void run();
  bool run_some();  // false if all jobs wait
  // Runs a step of the lane's first job; nothing if the lane is empty.
  std::optional<Step> step_lane(Lane lane);
  bool step_frames();
  bool step_behind_edits();
  void run_replies();
  void recover();
  void abort_all(const Error& problem);
  std::deque<Job>& queue(Lane lane) { return lanes_[static_cast<std::size_t>(lane)]; }

  const std::size_t capacity_;
  Hooks hooks_;
  std::thread thread_;
  std::mutex mutex_;  // guards what follows, up to the blank line
  std::condition_variable changed_;
  std::array<std::deque<Job>, 3> lanes_;
  std::deque<std::function<void()>> replies_;
  bool frame_queued_ = false;
  bool stopping_ = false;
  bool stopped_ = true;

  // Used by the GPU thread only.
  std::array<std::optional<Job>, 3> current_;  // of the lanes
  std::list<Job> frames_;
  // how much longer ordered jobs ran than frames since frames were last idle
  Clock::duration ahead_{};
  // a lost context that could not be replaced yet; other threads may read
  std::atomic<bool> broken_ = false;
  Clock::time_point next_recovery_{};
};

}  // namespace strata::render
