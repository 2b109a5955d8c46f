#pragma once

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "domain/people/question.h"

namespace strata::mesh {

// The number of threads for long work while users paint and view: half of the cores, at least two.
inline int background_threads() {
  return static_cast<int>(std::max(2u, std::thread::hardware_concurrency() / 2));
}

inline int hardware_threads() {
  return static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
}

// Runs work(0) … work(count - 1) on up to `threads` threads, including the calling thread. Runs
// each index once, in any order. Before each index it checks whether the current question
// (domain/people/question.h) may continue. The first exception ends the work and is rethrown here.
template <class Work>
void parallel_for(int threads, int count, Work&& work) {
  const QuestionTurn turn;
  Question* const question = Question::current();
  std::atomic<int> next{0};
  std::mutex mutex;
  std::exception_ptr failure;
  const auto run = [&] {
    try {
      for (int i = next++; i < count; i = next++) {
        turn.check();
        work(i);
      }
    } catch (...) {
      next = count;
      const std::lock_guard lock(mutex);
      if (!failure) failure = std::current_exception();
    }
  };
  {
    std::vector<std::jthread> others;
    for (int t = 1; t < std::min(threads, count); ++t)
      others.emplace_back([&] {
        const Question::Helper helper(question);
        run();
      });
    run();
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace strata::mesh
