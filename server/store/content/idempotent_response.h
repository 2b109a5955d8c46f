#pragma once

#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "core/ids.h"

namespace strata::store {

// The response to a request with an Idempotency-Key. It is stored in the transaction of the effect
// of the request, so after a crash either both exist or neither does. `make` converts the effect
// (the created or changed object) to the response. It may run more than once.
template <class... Effect>
struct IdempotentResponse {
  std::string key;  // if empty, no response is stored
  std::function<nlohmann::json(const Effect&...)> make;
  // The user who made the request, for the activity of the project. If it is empty, the activity
  // omits changes, and shows creations and deletions without the name of a user. (Journal entries
  // have a separate user name.)
  std::string user{};
  // The stored job that does this work, or 0 without a job. The same transaction marks the job as
  // done, with the result of `make` as its result.
  JobId job = 0;
};

}  // namespace strata::store
