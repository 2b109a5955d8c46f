#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "core/error.h"

namespace strata::store {

class Pool;

// Answers to HTTP calls that change something, by Idempotency-Key; kept for 7 days. Part of Store:
// its rules for threads and errors hold.
class Answers {
 public:
  explicit Answers(Pool& pool) : pool_(pool) {}

  Result<std::optional<nlohmann::json>> find(const std::string& key);

 private:
  Pool& pool_;
};

}  // namespace strata::store
