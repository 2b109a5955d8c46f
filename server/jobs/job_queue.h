#pragma once

#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/progress.h"

namespace strata::jobs {

enum class JobState { queued, running, done, failed, cancelled };

// What a job made.
struct JobResult {
  JobResult(std::int64_t the_model) : model(the_model) {}  // NOLINT(google-explicit-constructor): most make only that
  std::int64_t model = 0;
  std::vector<std::int64_t> layers;  // new ones on it
  std::optional<std::int64_t> look;  // a new one on it
  nlohmann::json report;             // what else is to be told, see the schema `JobReport`; null: nothing
};

struct JobStatus {
  std::int64_t id = 0;
  std::int64_t project = 0;  // whose members may know of it
  JobState state = JobState::queued;
  double progress = 0;
  std::string message;
  std::optional<Problem> problem;
  std::optional<JobResult> result;
};

// Long work, one at a time on a thread of its own, in order of asking. Finished jobs are remembered (the newest 1000) until the
// queue goes; ids are higher than those of every queue before, so that an id of then is never another job now.
class JobQueue {
 public:
  JobQueue();
  ~JobQueue();  // cancels what runs, joins
  using Work = std::function<Result<JobResult>(Progress&)>;
  Result<std::int64_t> add(std::int64_t project, Work work);  // refused (503) when 64 wait
  std::optional<JobStatus> status(std::int64_t id) const;
  std::vector<JobStatus> all() const;  // newest first
  bool cancel(std::int64_t id);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace strata::jobs
