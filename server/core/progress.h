#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>

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

  void cancel() { cancelled_ = true; }
  // Tests override it to cancel at a chosen place.
  virtual bool cancelled() const { return cancelled_; }

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
  JobId job_ = 0;
};

inline tl::unexpected<Error> cancelled_problem() {
  return fail(ErrorCode::cancelled, "Cancelled", "The work was cancelled.");
}

}  // namespace strata
