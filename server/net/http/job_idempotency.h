#pragma once

#include <map>
#include <mutex>

#include "core/ids.h"
#include "jobs/job_queue.h"
#include "net/http/http_types.h"

namespace strata::net {

// The job that a call's Idempotency-Key started. Kept in memory only. The database has the key of a
// job that succeeded, with its result; a repeat then gets a finished job. A key whose job a restart
// ended starts the job again. Thread-safe.
class JobIdempotency {
 public:
  explicit JobIdempotency(jobs::JobQueue& jobs) : jobs_(jobs) {}

  // Nothing: the key is new, or its job is forgotten. 422: the key was used with another body.
  Result<std::optional<JobId>> find(const Request& request);
  void started(const Request& request, JobId job);
  // Returns the job that an earlier server process finished.
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
