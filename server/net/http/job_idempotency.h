#pragma once

#include <map>
#include <mutex>

#include "core/ids.h"
#include "jobs/job_queue.h"
#include "net/http/http_types.h"

namespace strata::net {

// Finds the job that a call with an Idempotency-Key started. The keys of running jobs are kept only
// in memory. The database stores the key and the result of a job that succeeded, so a repeated call
// gets a finished job. If a restart of the server ended the job, a repeated call starts the job
// again. Thread-safe.
class JobIdempotency {
 public:
  explicit JobIdempotency(jobs::JobQueue& jobs) : jobs_(jobs) {}

  // Returns nothing if the key is new or its job is no longer listed. Returns 422 if the key was
  // used with another body.
  Result<std::optional<JobId>> find(const Request& request);
  void started(const Request& request, JobId job);
  // Adds a finished job of the caller for the result of a job that an earlier server process ran,
  // and returns it.
  Result<JobId> finished(const Request& request, ProjectId project, jobs::JobResult result,
                         jobs::JobKind kind);

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
