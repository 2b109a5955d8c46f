#pragma once

#include <chrono>
#include <future>
#include <memory>

#include "core/error.h"
#include "domain/people/question.h"

namespace strata::room {

// Starts a call that passes its result to a callback, and waits for this result. Must not run on
// the thread that calls the callback.
template <class T, class Start>
Result<T> await(Start start) {
  auto promise = std::make_shared<std::promise<Result<T>>>();
  auto future = promise->get_future();
  start([promise](Result<T> result) { promise->set_value(std::move(result)); });
  return future.get();
}

// Like `await`, but throws QuestionEnded if the current `Question` ends during the wait. The result
// is then dropped, so it must not be a resource that the caller has to release.
template <class T, class Start>
Result<T> await_for_question(Start start) {
  constexpr std::chrono::milliseconds kBetweenChecks{20};
  auto promise = std::make_shared<std::promise<Result<T>>>();
  auto future = promise->get_future();
  start([promise](Result<T> result) { promise->set_value(std::move(result)); });
  while (Question::current() && future.wait_for(kBetweenChecks) != std::future_status::ready)
    check_question();
  return future.get();
}

}  // namespace strata::room
