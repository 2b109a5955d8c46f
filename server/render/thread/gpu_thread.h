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

// The result of a job's step. A step takes a few milliseconds at most, so long work is divided into
// many steps.
enum class Step {
  more,     // has more work
  yield,    // like `more`, but a step of a later lane may run first: for long jobs
  waiting,  // waits for the GPU, so other jobs may run
  done,
};

// Work for the GPU thread. It ends with a step that returns `done`, or with `abort`.
struct Job {
  std::function<Step()> step;
  std::function<void(const Error&)> abort;
};

enum class Lane {
  // Edits and layer changes, one after another, before all other work.
  ordered,
  // Uploads of models, surface images and surface maps, one after another, after frames.
  background,
  // Refinements of frames, one after another, while no other work is in progress.
  idle,
};

// The thread that owns the GPU. Ordered jobs precede frames, and frames precede background jobs.
// While a job waits, jobs of the next kind run, but jobs of one lane keep their order. Frames wait
// while an ordered job can run and does not yield. After ordered jobs have run for some time,
// frames get an equal time. So users see the first results while many edits run.
class GpuThread {
 public:
  struct Hooks {
    std::function<Result<void>()> start;    // creates the context; `start` returns its Error
    std::function<void()> stop;             // destroys the context
    std::function<bool()> lost;             // called before each step
    std::function<Result<void>()> recover;  // replaces a lost context, after all jobs were aborted
    std::function<std::optional<Job>()> next_frame;  // takes a waiting frame that may start
    // Takes a waiting frame that should precede the frames in progress.
    std::function<std::optional<Job>()> next_part;
    std::function<void(const Error&)> abort_frames;  // aborts all waiting frames
  };

  explicit GpuThread(std::size_t capacity) : capacity_(capacity) {}
  ~GpuThread() { stop(); }
  GpuThread(const GpuThread&) = delete;
  GpuThread& operator=(const GpuThread&) = delete;

  Result<void> start(Hooks hooks);
  // Aborts waiting jobs and joins the thread. Must not be called on the GPU thread.
  void stop();

  // Returns false if the thread has stopped, or if the lane is full and `always` is false. The
  // caller must then abort the job. `always` is for removals, at most one for each handle, and for
  // callers that wait for the end of a lane.
  bool post(Lane lane, Job job, bool always = false);
  // Runs `reply` on the GPU thread before any other work, or on the calling thread if the GPU
  // thread has stopped. The number of replies needs no limit, because each request has at most one.
  void post_reply(std::function<void()> reply);
  void wake();  // called when a frame is queued
  bool ready() const { return !broken_; }

 private:
  using Clock = std::chrono::steady_clock;

  void run();
  bool run_some();  // returns false if all jobs wait
  // Runs a step of the lane's first job. Returns nothing if the lane is empty.
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
  std::mutex mutex_;  // guards the members up to the blank line
  std::condition_variable changed_;
  std::array<std::deque<Job>, 3> lanes_;
  std::deque<std::function<void()>> replies_;
  bool frame_queued_ = false;
  bool stopping_ = false;
  bool stopped_ = true;

  // Only the GPU thread uses these members.
  std::array<std::optional<Job>, 3> current_;  // the current job of each lane
  std::list<Job> frames_;
  // The time of ordered jobs minus the time of frames, since the last time that either of the two
  // had no work.
  Clock::duration ahead_{};
  // True while a lost context could not be replaced. Other threads may read it.
  std::atomic<bool> broken_ = false;
  Clock::time_point next_recovery_{};
};

}  // namespace strata::render
