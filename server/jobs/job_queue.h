#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/ids.h"
#include "core/progress.h"
#include "core/temporary_file.h"

namespace strata::store {
class Jobs;
}

namespace strata::jobs {

// The result type of a job.
enum class JobKind { import, layers, image, figure };
enum class JobState { queued, running, done, failed, cancelled };

// The result of a job.
struct JobResult {
  JobResult(ModelId the_model)
      : model(the_model) {}  // NOLINT(google-explicit-constructor): most make only a model
  ModelId model = 0;
  std::vector<LayerId> layers;          // new ones on it
  std::optional<SurfaceImageId> image;  // a new one on it
  // a report for the user, see the schema `TransferReport`; null: no report
  nlohmann::json report;
  std::shared_ptr<const TemporaryFile> file;
};

struct JobStatus {
  JobId id = 0;
  ProjectId project = 0;  // only its members may see the job
  std::string user;       // the user who started it; empty: the server
  JobKind kind = JobKind::import;
  JobState state = JobState::queued;
  double progress = 0;
  std::string message;
  std::optional<Error> problem;
  std::optional<JobResult> result;
};

// Runs long work, one job at a time on a separate thread, in the order of the requests. Keeps the
// newest 1000 finished jobs, and the files of the newest kFilesKept jobs that made one, until the
// queue is destroyed. Ids are higher than those of all earlier queues, so that an old id never
// names a new job.
class JobQueue {
 public:
  static constexpr int kFilesKept = 16;
  // With `store`, jobs outlive the queue for store::Jobs::kDaysKept days, without their files:
  // unfinished jobs of an earlier queue have failed. `store` must outlive the queue. Blocks.
  explicit JobQueue(store::Jobs* store = nullptr);
  ~JobQueue();  // cancels the running job, joins
  using Work = std::function<Result<JobResult>(Progress&)>;
  // Refused (unavailable) when 64 jobs wait, or as the store refuses. Blocks while the store is
  // written.
  Result<JobId> add(ProjectId project, Work work, std::string user = {},
                    JobKind kind = JobKind::import);
  std::optional<JobStatus> status(JobId id) const;
  std::vector<JobStatus> all() const;  // newest first
  bool cancel(JobId id);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace strata::jobs
