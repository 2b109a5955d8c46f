#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/ids.h"

namespace strata::store {

class Pool;

// A job as stored in the database.
struct StoredJob {
  JobId id = 0;
  ProjectId project_id = 0;
  std::string user;  // the user who started it; empty: no particular user
  std::string kind;  // "import", "layers", "look", "figure"
  // "done", "failed", "cancelled"; "lost": the server ended before the job did
  std::string state;
  nlohmann::json problem;  // code, title, detail, field; null: no problem
  // "model", "layers", "look", "report", as far as the job made them; null: no result
  nlohmann::json result;
};

// Jobs that can be found again after a restart. Part of Store: thread-safe and blocking as Store
// is. The success of a job is written in the transaction of its result (`IdempotentResponse::job`),
// so that neither exists without the other.
class Jobs {
 public:
  static constexpr int kDaysKept = 7;

  explicit Jobs(Pool& pool) : pool_(pool) {}

  // Called when a server starts: marks the unfinished jobs of the previous server as lost, and
  // deletes jobs that ended more than kDaysKept days ago. Returns the newest `most` of the other
  // jobs, newest first.
  Result<std::vector<StoredJob>> take_over(int most);
  Result<void> begin(const StoredJob& job);  // not_found: the project does not exist
  // Writes the end of a job. A job that a transaction has marked as done stays done.
  Result<void> end(const StoredJob& job);

 private:
  Pool& pool_;
};

}  // namespace strata::store
