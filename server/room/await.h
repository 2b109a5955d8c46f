#pragma once

#include <future>
#include <memory>

#include "core/problem.h"

namespace strata::room {

// Starts a call that answers by callback and waits for the answer. Not on the thread that answers.
template <class T, class Start>
Result<T> await(Start start) {
  auto promise = std::make_shared<std::promise<Result<T>>>();
  auto future = promise->get_future();
  start([promise](Result<T> result) { promise->set_value(std::move(result)); });
  return future.get();
}

}  // namespace strata::room
