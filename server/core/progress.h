#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/ids.h"

namespace strata {

// The progress of a long task, shared with its observers. The worker calls `report`. When
// `cancelled()` becomes true, the worker soon returns `cancelled_problem()`. Thread-safe.
class Progress {
 public:
  virtual ~Progress() = default;

  // Divides the task into `count` parts of equal length and begins the part with this number, from
  // 1. The stages and messages of the code that does the part then belong to the part only.
  void begin_part(int number, int count) {
    std::lock_guard lock(mutex_);
    part_ = number;
    parts_ = count;
    from_ = 0;
    to_ = 1;
    set(0, "");
  }
  // Maps later reports to the part [from, to] of the whole task. So the code of a step does not
  // depend on its position in the task.
  void begin_stage(double from, double to) {
    std::lock_guard lock(mutex_);
    from_ = from;
    to_ = to;
  }
  // Maps later reports to a share of the current stage, until this object is destroyed.
  class Share {
   public:
    Share(Progress& progress, double from, double to) : progress_(progress) {
      std::lock_guard lock(progress_.mutex_);
      from_ = progress_.from_;
      to_ = progress_.to_;
      progress_.from_ = from_ + (to_ - from_) * from;
      progress_.to_ = from_ + (to_ - from_) * to;
    }
    ~Share() { progress_.begin_stage(from_, to_); }
    Share(const Share&) = delete;
    Share& operator=(const Share&) = delete;

   private:
    Progress& progress_;
    double from_ = 0, to_ = 1;
  };
  void report(double fraction, std::string message) {
    std::lock_guard lock(mutex_);
    set(fraction, std::move(message));
  }
  double fraction() const {
    std::lock_guard lock(mutex_);
    return fraction_;
  }
  std::string message() const {
    std::lock_guard lock(mutex_);
    return message_;
  }
  // Returns the id of the job, or 0 if the task is not a job. Results store this id.
  JobId job() const { return job_; }
  void set_job(JobId job) { job_ = job; }  // call before the work begins

  void cancel() {
    std::lock_guard lock(mutex_);
    if (cancelled_.exchange(true)) return;
    for (const auto* watcher : watchers_) watcher->stop_();
  }
  // Tests override it to cancel at a chosen place.
  virtual bool cancelled() const { return cancelled_; }

  // Calls `stop` if the task has been cancelled, or as soon as it is cancelled during the lifetime
  // of this object. For work that does not ask `cancelled()`. `stop` must not use the Progress.
  class WhenCancelled {
   public:
    WhenCancelled(Progress& progress, std::function<void()> stop)
        : progress_(progress), stop_(std::move(stop)) {
      std::lock_guard lock(progress_.mutex_);
      progress_.watchers_.push_back(this);
      if (progress_.cancelled_) stop_();
    }
    ~WhenCancelled() {
      std::lock_guard lock(progress_.mutex_);
      std::erase(progress_.watchers_, this);
    }
    WhenCancelled(const WhenCancelled&) = delete;
    WhenCancelled& operator=(const WhenCancelled&) = delete;

   private:
    friend class Progress;
    Progress& progress_;
    const std::function<void()> stop_;
  };

 private:
  void set(double fraction, std::string message) {
    fraction_ = (part_ - 1 + from_ + (to_ - from_) * fraction) / parts_;
    message_ = std::move(message);
    if (parts_ == 1) return;
    const std::string part = "Step " + std::to_string(part_) + " of " + std::to_string(parts_);
    message_ = message_.empty() ? part : part + ": " + message_;
  }

  mutable std::mutex mutex_;
  int part_ = 1, parts_ = 1;
  double from_ = 0, to_ = 1;
  double fraction_ = 0;
  std::string message_;
  std::atomic<bool> cancelled_{false};
  std::vector<const WhenCancelled*> watchers_;
  JobId job_ = 0;
};

inline tl::unexpected<Error> cancelled_problem() {
  return fail(ErrorCode::cancelled, "Cancelled", "The work was cancelled.");
}

}  // namespace strata
