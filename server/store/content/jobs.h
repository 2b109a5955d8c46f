#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/ids.h"

namespace strata::store {

class Pool;

// A job as the database has it.
struct StoredJob {
  JobId id = 0;
  ProjectId project_id = 0;
  std::string user;  // who started it; empty: nobody in particular
  std::string kind;  // "import", "layers", "look", "figure"
  // "done", "failed", "cancelled"; "lost": the server ended before the job did
  std::string state;
  nlohmann::json problem;  // code, title, detail, field; null: none
  // "model", "layers", "look", "report" as far as it made them; null: nothing
  nlohmann::json result;
};

// What is known of long work after a restart; of a Store, and as thread-safe and blocking as that.
// A job's success is written in the transaction of what it made (`IdempotentResponse::job`), so
// that neither is there without the other.
class Jobs {
 public:
  static constexpr int kDaysKept = 7;

  explicit Jobs(Pool& pool) : pool_(pool) {}

  // When a server starts: what the one before left unfinished is lost from now on, and jobs that
  // ended more than kDaysKept days ago are forgotten. The newest `most` of the others, the newest
  // first.
  Result<std::vector<StoredJob>> take_over(int most);
  Result<void> begin(const StoredJob& job);  // not_found: the project is not there
  // The end that it came to. What a transaction has written as done stays.
  Result<void> end(const StoredJob& job);

 private:
  Pool& pool_;
};

}  // namespace strata::store
