#pragma once

#include <array>
#include <cstddef>
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
#include "core/uuid.h"

namespace strata::store {
class Jobs;
}

namespace strata::jobs {

// The kind of a job's result. A figure is any file for the user who started the job.
enum class JobKind { import, layers, image, figure, regions, changes, analysis };
enum class JobState { queued, running, done, failed, cancelled };

// The result of a job.
struct JobResult {
  JobResult(ModelId the_model)
      : model(the_model) {}  // NOLINT(google-explicit-constructor): most make only a model
  ModelId model = 0;
  std::vector<LayerId> layers;          // new layers of the model
  std::optional<SurfaceImageId> image;  // a new surface image of the model
  // A report for the user, whose schema depends on the kind of the job. Null: no report.
  nlohmann::json report;
  std::shared_ptr<const TemporaryFile> file;
};

struct JobStatus {
  JobId id = 0;
  ProjectId project = 0;  // only members of this project may see the job
  std::string user;       // the user who started the job; empty: the server
  JobKind kind = JobKind::import;
  JobState state = JobState::queued;
  double progress = 0;
  std::string message;
  std::optional<Error> problem;
  std::optional<JobResult> result;
};

// Runs long work on separate threads, one job at a time in the order of the requests, because a job
// can need most of the memory. Only files (JobKind::figure), which need little memory, are also
// made during other jobs, one file at a time. Until the queue is destroyed, it keeps the newest
// 1000 finished jobs, and the files of the newest kFilesKept jobs with a file. Ids are higher than
// the ids of all earlier queues, so an old id never refers to a new job.
class JobQueue {
 public:
  static constexpr int kFilesKept = 16;
  // With `store`, jobs are kept for store::Jobs::kDaysKept days, also after the queue is destroyed,
  // but without their files. Unfinished jobs of an earlier queue are reported as failed. `store`
  // must outlive the queue. `node` is this server, if the site has several servers. Blocks.
  explicit JobQueue(store::Jobs* store = nullptr, std::optional<Uuid> node = {});
  ~JobQueue();
  // Cancels the running jobs, joins the threads and refuses new jobs. Call it before the objects
  // that jobs use are destroyed. The destructor also calls it. Idempotent.
  void stop();
  using Work = std::function<Result<JobResult>(Progress&)>;
  // Fails with `busy` if 64 jobs wait, with `unavailable` if the queue is stopping, or with the
  // Error of the store. Blocks while it writes to the store.
  Result<JobId> add(ProjectId project, Work work, std::string user = {},
                    JobKind kind = JobKind::import);
  std::optional<JobStatus> status(JobId id) const;
  std::vector<JobStatus> all() const;  // newest job first
  bool cancel(JobId id);
  // Returns the number of kept jobs in each JobState.
  std::array<std::size_t, 5> counts() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace strata::jobs
