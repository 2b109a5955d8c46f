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

// What a job makes.
enum class JobKind { import, layers, image, figure };
enum class JobState { queued, running, done, failed, cancelled };

// What a job made.
struct JobResult {
  JobResult(ModelId the_model)
      : model(the_model) {}  // NOLINT(google-explicit-constructor): most make only that
  ModelId model = 0;
  std::vector<LayerId> layers;          // new ones on it
  std::optional<SurfaceImageId> image;  // a new one on it
  // what else is to be told, see the schema `TransferReport`; null: nothing
  nlohmann::json report;
  std::shared_ptr<const TemporaryFile> file;
};

struct JobStatus {
  JobId id = 0;
  ProjectId project = 0;  // whose members may know of it
  std::string user;       // who started it; empty: the server itself
  JobKind kind = JobKind::import;
  JobState state = JobState::queued;
  double progress = 0;
  std::string message;
  std::optional<Error> problem;
  std::optional<JobResult> result;
};

// Long work, one at a time on a thread of its own, in order of asking. Finished jobs are
// remembered: the newest 1000; their files, of the newest kFilesKept that made one, until the queue
// goes. Ids are higher than those of every queue before, so that an id of then is never another job
// now.
class JobQueue {
 public:
  static constexpr int kFilesKept = 16;
  // With `store` jobs outlive the queue for store::Jobs::kDaysKept days, without their files: what
  // a queue before did not finish has failed. `store` outlives the queue. Blocks.
  explicit JobQueue(store::Jobs* store = nullptr);
  ~JobQueue();  // cancels what runs, joins
  using Work = std::function<Result<JobResult>(Progress&)>;
  // Refused (unavailable) when 64 wait, or as the store refuses. Blocks while the store is written.
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
