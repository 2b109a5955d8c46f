#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/ids.h"
#include "core/uuid.h"

namespace strata::store {

class Pool;

// A job as stored in the database.
struct StoredJob {
  JobId id = 0;
  ProjectId project_id = 0;
  std::string user;  // the user who started it; empty for no particular user
  std::string kind;  // "import", "layers", "look", "figure", "regions"
  // "done", "failed", "cancelled"; "lost": the server ended before the job did
  std::string state;
  nlohmann::json problem;  // code, title, detail, field; null if there was no problem
  // "model", "layers", "look", "report", if the job made them; null if there is no result
  nlohmann::json result;
  std::optional<Uuid> node{};  // the node that runs it, if the site has several
};

// Jobs that can be found again after a restart. Part of Store, whose rules for threads and errors
// apply. The success of a job is written in the transaction of its result
// (`IdempotentResponse::job`), so neither exists without the other.
class Jobs {
 public:
  static constexpr int kDaysKept = 7;

  explicit Jobs(Pool& pool) : pool_(pool) {}

  // Called when a server starts: marks the unfinished jobs of the previous server as lost, and
  // deletes jobs that ended more than kDaysKept days ago. Does not change the unfinished jobs of
  // nodes that have a lease. Returns the newest `most` of the jobs that ended, newest first.
  Result<std::vector<StoredJob>> take_over(int most);
  // Returns `not_found` if the project does not exist, and `conflict` if another node has already
  // used the id.
  Result<void> begin(const StoredJob& job);
  // Writes the end of a job. A job that a transaction has marked as done stays done.
  Result<void> end(const StoredJob& job);

 private:
  Pool& pool_;
};

}  // namespace strata::store
