#include <gtest/gtest.h>

#include <numeric>
#include <thread>
#include <vector>

#include "core/histogram.h"

namespace strata {
namespace {

using namespace std::chrono_literals;

TEST(Histogram, a_duration_counts_in_the_first_interval_that_contains_it) {
  Histogram histogram;
  histogram.add(0ns);
  histogram.add(500us);  // the bound belongs to its interval
  histogram.add(501us);
  histogram.add(2h);
  const auto counts = histogram.counts();
  EXPECT_EQ(counts.by_interval.front(), 2u);
  EXPECT_EQ(counts.by_interval[1], 1u);
  EXPECT_EQ(counts.by_interval.back(), 1u);
  EXPECT_NEAR(counts.sum_s, 7200.001001, 1e-6);
}

TEST(Histogram, no_duration_of_any_thread_is_lost) {
  Histogram histogram;
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t)
    threads.emplace_back([&] {
      for (int i = 0; i < 10'000; ++i) histogram.add(1ms);
    });
  for (auto& thread : threads) thread.join();
  const auto counts = histogram.counts();
  EXPECT_EQ(std::accumulate(counts.by_interval.begin(), counts.by_interval.end(), std::uint64_t{}),
            40'000u);
  EXPECT_NEAR(counts.sum_s, 40, 1e-6);
}

}  // namespace
}  // namespace strata
