#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>

namespace strata {

// Counts durations in fixed intervals, for the metrics of the server. All threads may add and read
// without a lock. During an addition, a reader may find the duration only in the sum or the count.
class Histogram {
 public:
  // Upper bounds in seconds, inclusive. A last interval has no upper bound.
  static constexpr std::array kBounds_s{0.0005, 0.001, 0.0025, 0.005, 0.01, 0.025, 0.05, 0.1,
                                        0.25,   0.5,   1.0,    2.5,   5.0,  10.0,  30.0};

  void add(std::chrono::nanoseconds duration) {
    const double seconds = std::chrono::duration<double>(duration).count();
    const auto interval = static_cast<std::size_t>(
        std::lower_bound(kBounds_s.begin(), kBounds_s.end(), seconds) - kBounds_s.begin());
    counts_[interval].fetch_add(1, std::memory_order_relaxed);
    sum_ns_.fetch_add(static_cast<std::uint64_t>(std::max<std::int64_t>(0, duration.count())),
                      std::memory_order_relaxed);
  }

  struct Counts {
    std::array<std::uint64_t, kBounds_s.size() + 1> by_interval{};
    double sum_s = 0;
  };
  Counts counts() const {
    Counts counts;
    for (std::size_t i = 0; i < counts_.size(); ++i)
      counts.by_interval[i] = counts_[i].load(std::memory_order_relaxed);
    counts.sum_s = static_cast<double>(sum_ns_.load(std::memory_order_relaxed)) * 1e-9;
    return counts;
  }

 private:
  std::array<std::atomic<std::uint64_t>, kBounds_s.size() + 1> counts_{};
  std::atomic<std::uint64_t> sum_ns_{0};
};

}  // namespace strata
