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

  // Maps later reports to the part [from, to] of the whole task. So the code of a step does not
  // depend on its position in the task.
  void begin_stage(double from, double to) {
    std::lock_guard lock(mutex_);
    from_ = from;
    to_ = to;
  }
  void report(double fraction, std::string message) {
    std::lock_guard lock(mutex_);
    fraction_ = from_ + (to_ - from_) * fraction;
    message_ = std::move(message);
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
  mutable std::mutex mutex_;
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
