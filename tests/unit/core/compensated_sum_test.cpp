// Sums of many doubles are exact to the last digit.
#include "core/compensated_sum.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace strata {
namespace {

TEST(CompensatedSum, ten_million_tenths_are_a_million) {
  CompensatedSum sum;
  double plain = 0;
  for (int i = 0; i < 10'000'000; ++i) {
    sum += 0.1;
    plain += 0.1;
  }
  EXPECT_EQ(sum.value(), 1e6);
  EXPECT_EQ(sum.value() / 10'000'000, 0.1);
  EXPECT_NE(plain, 1e6);  // the reason for CompensatedSum
}

TEST(CompensatedSum, small_numbers_between_large_ones_are_kept_in_any_order) {
  std::vector<double> values{1e16, 1, 1e-3, -1e16, 2, 1e8, -1e8};
  std::ranges::sort(values);
  do {
    CompensatedSum sum;
    for (const double value : values) sum += value;
    EXPECT_EQ(sum.value(), 3.001);
  } while (std::ranges::next_permutation(values).found);
}

TEST(CompensatedSum, sums_of_parts_are_the_sum_of_all) {
  std::mt19937 random(3);
  std::vector<double> values;
  for (int i = 0; i < 100'000; ++i)
    values.push_back(
        std::ldexp(static_cast<double>(random() % 1000), static_cast<int>(random() % 60)));
  CompensatedSum all, joined, part;
  for (std::size_t i = 0; i < values.size(); ++i) {
    all += values[i];
    part += values[i];
    if (i % 777 != 0) continue;
    joined += part;
    part = {};
  }
  joined += part;
  long double exact = 0;  // has 64 bits of fraction
  for (const double value : values) exact += value;
  EXPECT_EQ(joined.value(), all.value());
  EXPECT_EQ(all.value(), static_cast<double>(exact));
}

}  // namespace
}  // namespace strata
