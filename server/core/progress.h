#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>

#include "core/error.h"
#include "core/ids.h"

namespace strata {

// Shared between a long task and its observers. The worker calls `report`, and when `cancelled()`
// becomes true it soon stops by returning `cancelled_problem()`. Thread-safe.
class Progress {
 public:
  // Maps later reports to the share [from, to] of the whole, so that a step does not depend on its
  // place in the task.
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
  // The reporting job, for the stored result; 0: no job.
  JobId job() const { return job_; }
  void set_job(JobId job) { job_ = job; }  // before the work begins

  void cancel() { cancelled_ = true; }
  bool cancelled() const { return cancelled_; }

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
