#pragma once

#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "core/ids.h"

namespace strata::store {

// The answer to a call with an Idempotency-Key, stored in the transaction of the call's effect:
// after a crash, either both exist or neither does. `make` turns the effect (the created or changed
// object) into the answer; it may run more than once.
template <class... Effect>
struct IdempotentResponse {
  std::string key;  // empty: no answer is stored
  std::function<nlohmann::json(const Effect&...)> make;
  // The user who made the call, for the project's activity. Empty: the activity does not list
  // changes, and lists creations and deletions without a name. (Journal entries have a separate
  // user name.)
  std::string user{};
  // The stored job that does this work: the same transaction marks it as done, with `make` as its
  // result. 0: no job.
  JobId job = 0;
};

}  // namespace strata::store
