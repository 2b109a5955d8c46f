#pragma once

#include <map>
#include <mutex>

#include "core/ids.h"
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
  Result<std::optional<JobId>> find(const Request& request);
  void started(const Request& request, JobId job);
  // The job that an earlier server finished.
  Result<JobId> finished(const Request& request, ProjectId project, jobs::JobResult result);

 private:
  struct Started {
    JobId job;
    std::string fingerprint;
  };
  jobs::JobQueue& jobs_;
  std::mutex mutex_;
  std::map<std::string, Started> started_;  // by scoped key
};

}  // namespace strata::net
