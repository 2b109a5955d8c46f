#pragma once

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

namespace strata::mesh {

// For long work beside which others paint and look: on many cores it leaves them the other half.
inline int background_threads() { return static_cast<int>(std::max(2u, std::thread::hardware_concurrency() / 2)); }

inline int hardware_threads() { return static_cast<int>(std::max(1u, std::thread::hardware_concurrency())); }

// Runs work(0) … work(count - 1) on up to `threads` threads (this one among them), each index once, in any order.
template <class Work>
void parallel_for(int threads, int count, Work&& work) {
  std::atomic<int> next{0};
  const auto run = [&] {
    for (int i = next++; i < count; i = next++) work(i);
  };
  std::vector<std::jthread> others;
  for (int t = 1; t < std::min(threads, count); ++t) others.emplace_back(run);
  run();
}

}  // namespace strata::mesh
