#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "core/error.h"

namespace strata::store {

class Pool;

// Responses to HTTP requests that change data, by Idempotency-Key. They are kept for 7 days. Part
// of Store, whose rules for threads and errors apply.
class Answers {
 public:
  explicit Answers(Pool& pool) : pool_(pool) {}

  Result<std::optional<nlohmann::json>> find(const std::string& key);

 private:
  Pool& pool_;
};

}  // namespace strata::store
