#include "render/thread/gpu_thread.h"

#include <pthread.h>

#include <algorithm>
#include <future>

#include "core/log.h"

namespace strata::render {
namespace {

// The time of polling without sleep. The read-back of an edit is usually ready within microseconds.
constexpr auto kBusyPolling = std::chrono::microseconds(200);
constexpr auto kPollPause = std::chrono::microseconds(100);
constexpr auto kRecoveryPause = std::chrono::seconds(1);
// The largest number of frames in progress. More frames would only use memory, because drawn frames
// wait for their read-back.
constexpr std::size_t kMaxActiveFrames = 4;
// The longest time of edits before a frame gets a turn. A stroke takes a few milliseconds, so only
// very many edits take this long.
constexpr std::chrono::milliseconds kMaxAhead{30};

Error lost_problem() {
  return {ErrorCode::gpu_lost,
          "GPU lost",
          "The server lost the GPU context and is restoring it, so it could not do this. "
          "Send the request again.",
          {}};
}

}  // namespace

Result<void> GpuThread::start(Hooks hooks) {
  hooks_ = std::move(hooks);
  std::promise<Result<void>> started;
  auto answer = started.get_future();
  thread_ = std::thread([this, &started] {
    pthread_setname_np(pthread_self(), "strata-gpu");
    auto result = hooks_.start();
    const bool works = result.has_value();
    if (works) {
      std::lock_guard lock(mutex_);
      stopped_ = false;
    }
    started.set_value(std::move(result));
    if (works) run();
  });
  auto result = answer.get();
  if (!result) thread_.join();
  return result;
}

void GpuThread::stop() {
  {
    std::lock_guard lock(mutex_);
    stopping_ = true;
    changed_.notify_all();
  }
  if (thread_.joinable()) thread_.join();
}

bool GpuThread::post(Lane lane, Job job, bool always) {
  std::lock_guard lock(mutex_);
  if (stopping_ || stopped_) return false;
  if (!always && queue(lane).size() >= capacity_) return false;
  queue(lane).push_back(std::move(job));
  changed_.notify_one();
  return true;
}

void GpuThread::post_reply(std::function<void()> reply) {
  {
    std::lock_guard lock(mutex_);
    if (!stopped_) {
      replies_.push_back(std::move(reply));
      changed_.notify_one();
      return;
    }
  }
  reply();
}

void GpuThread::wake() {
  std::lock_guard lock(mutex_);
  frame_queued_ = true;
  changed_.notify_one();
}

void GpuThread::run() {
  auto last_progress = Clock::now();
  for (;;) {
    run_replies();
    {
      std::lock_guard lock(mutex_);
      if (stopping_) break;
    }
    if (broken_ ? Clock::now() >= next_recovery_ : hooks_.lost()) recover();
    if (!broken_ && run_some()) {
      last_progress = Clock::now();
      continue;
    }
    if (broken_) abort_all(lost_problem());
    std::unique_lock lock(mutex_);
    const auto has_news = [&] {
      bool has_job = false;
      for (std::size_t i = 0; i < lanes_.size(); ++i)
        has_job = has_job || (!current_[i] && !lanes_[i].empty());
      return stopping_ || !replies_.empty() || frame_queued_ || has_job;
    };
    const bool is_under_way =
        std::ranges::any_of(current_, [](const auto& job) { return job.has_value(); });
    if (is_under_way || !frames_.empty()) {
      // A job waits for the GPU.
      if (Clock::now() - last_progress > kBusyPolling)
        changed_.wait_for(lock, kPollPause, has_news);
    } else if (broken_) {
      changed_.wait_for(lock, kRecoveryPause, has_news);
    } else {
      changed_.wait(lock, has_news);
    }
    frame_queued_ = false;
  }
  abort_all({ErrorCode::unavailable,
             "Renderer stopped",
             "The server is shutting down. Try again when it is running again.",
             {}});
  hooks_.stop();
  {
    std::lock_guard lock(mutex_);
    stopped_ = true;
  }
  abort_all({ErrorCode::unavailable,
             "Renderer stopped",
             "The server is shutting down. Try again when it is running again.",
             {}});
  run_replies();
}

bool GpuThread::run_some() {
  if (ahead_ > kMaxAhead) {
    const auto begin = Clock::now();
    const bool is_drawn = step_frames();
    ahead_ = is_drawn ? ahead_ - (Clock::now() - begin) : Clock::duration{};
    if (is_drawn) return true;
  }
  const auto begin = Clock::now();
  const auto step = step_lane(Lane::ordered);
  if (step && *step != Step::waiting && *step != Step::yield) {
    ahead_ += Clock::now() - begin;
    return true;
  }
  ahead_ = {};
  return step_behind_edits() || step == Step::yield;
}

bool GpuThread::step_behind_edits() {
  if (step_frames()) return true;
  const auto step = step_lane(Lane::background);
  if (step && *step != Step::waiting) return true;
  // If a frame waits for the GPU, the work of an idle job would delay it.
  if (step || !frames_.empty() || current_[0]) return false;
  const auto idle = step_lane(Lane::idle);
  return idle && *idle != Step::waiting;
}

std::optional<Step> GpuThread::step_lane(Lane lane) {
  auto& current = current_[static_cast<std::size_t>(lane)];
  if (!current) {
    std::lock_guard lock(mutex_);
    if (queue(lane).empty()) return std::nullopt;
    current = std::move(queue(lane).front());
    queue(lane).pop_front();
  }
  const Step step = current->step();
  if (step == Step::done) current.reset();
  return step;
}

// Runs a step of the first frame that does not wait for the GPU. Starts a new frame if all others
// wait for the GPU, or if a small frame's turn precedes theirs.
bool GpuThread::step_frames() {
  if (!frames_.empty() && frames_.size() < kMaxActiveFrames)
    if (auto part = hooks_.next_part()) frames_.push_front(std::move(*part));
  for (auto frame = frames_.begin(); frame != frames_.end(); ++frame) {
    const Step step = frame->step();
    if (step == Step::waiting) continue;
    if (step == Step::done) frames_.erase(frame);
    return true;
  }
  if (frames_.size() >= kMaxActiveFrames) return false;
  auto next = hooks_.next_frame();
  if (!next) return false;
  frames_.push_back(std::move(*next));
  return true;
}

void GpuThread::run_replies() {
  std::deque<std::function<void()>> replies;
  {
    std::lock_guard lock(mutex_);
    replies.swap(replies_);
  }
  for (auto& reply : replies) reply();
}

void GpuThread::recover() {
  abort_all(lost_problem());
  auto recovered = hooks_.recover();
  broken_ = !recovered;
  if (broken_) {
    log::error("The GPU context could not be rebuilt, trying again: " + recovered.error().detail);
    next_recovery_ = Clock::now() + kRecoveryPause;
  }
}

void GpuThread::abort_all(const Error& problem) {
  std::deque<Job> jobs;
  for (auto& current : current_) {
    if (current) jobs.push_back(std::move(*current));
    current.reset();
  }
  for (auto& frame : frames_) jobs.push_back(std::move(frame));
  frames_.clear();
  {
    std::lock_guard lock(mutex_);
    for (auto& lane : lanes_) {
      for (auto& job : lane) jobs.push_back(std::move(job));
      lane.clear();
    }
  }
  for (auto& job : jobs) job.abort(problem);
  hooks_.abort_frames(problem);
}

}  // namespace strata::render
