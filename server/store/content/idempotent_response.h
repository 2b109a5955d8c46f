#pragma once

#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "core/ids.h"

namespace strata::store {

// The answer to a call with an Idempotency-Key, kept in the transaction of the call's effect:
// either both are there or neither, whatever dies in between. `make` turns the effect (what was
// created or changed) into the answer; it may run more than once.
template <class... Effect>
struct IdempotentResponse {
  std::string key;  // empty: none is kept
  std::function<nlohmann::json(const Effect&...)> make;
  // Who asked, for the project's activity; empty: nobody, so that what is changed is not told
  // there, and what is made or deleted is by no name. (Entries of journals have names of their
  // own.)
  std::string user{};
  // The job that does it, of the jobs that are kept: in the same transaction it is done, and `make`
  // says what it made. 0: no job.
  JobId job = 0;
};

}  // namespace strata::store
