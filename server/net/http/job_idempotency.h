#pragma once

#include <map>
#include <mutex>

#include "jobs/job_queue.h"
#include "net/http/http_types.h"

namespace strata::net {

// Which job a call's Idempotency-Key started. The server forgets when it stops; the key of a job
// that succeeded is in the database with what it made, and gets a job that is done. The key of one
// that a restart ended starts it again. Thread-safe.
class JobIdempotency {
 public:
  explicit JobIdempotency(jobs::JobQueue& jobs) : jobs_(jobs) {}

  // Nothing: the key is new, or its job is forgotten. 422: it was used with another body.
  Result<std::optional<std::int64_t>> find(const Request& request);
  void started(const Request& request, std::int64_t job);
  // The job that an earlier server finished.
  Result<std::int64_t> finished(const Request& request, std::int64_t project,
                                jobs::JobResult result);

 private:
  struct Started {
    std::int64_t job;
    std::string fingerprint;
  };
  jobs::JobQueue& jobs_;
  std::mutex mutex_;
  std::map<std::string, Started> started_;  // by scoped key
};

}  // namespace strata::net
