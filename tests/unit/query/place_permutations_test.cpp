// Chances of sums, compared with shuffling all values.
#include "query/regions/place_permutations.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

namespace strata::query {
namespace {

// Places of one texel each.
struct PlacesOfOneTexel {
  explicit PlacesOfOneTexel(std::vector<double> given)
      : values(std::move(given)), areas((values.size() + 63) / 64 * 64) {
    const std::size_t number = values.size();
    valid.resize(areas.size() / 64);
    places.means.bits.resize(areas.size());
    for (std::size_t i = 0; i < number; ++i) {
      const auto value = static_cast<float>(values[i]);
      values[i] = double{value};
      areas[i] = 2;
      valid[i / 64] |= std::uint64_t{1} << i % 64;
      places.means.bits[i] = std::bit_cast<std::uint32_t>(value);
    }
    const auto count = static_cast<double>(number);
    places.mean = std::accumulate(values.begin(), values.end(), 0.0) / count;
    places.deviation = 1;
    places.number = count;
    places.area = 2;
    places.valid = &valid;
  }
  std::vector<double> values;
  std::vector<float> areas;
  std::vector<std::uint64_t> valid;
  EqualPlaces places;
};

std::vector<double> skewed_values(std::size_t number) {
  std::mt19937 random(11);
  std::exponential_distribution<double> skewed(1);
  std::vector<double> values(number);
  for (double& value : values) value = skewed(random);
  return values;
}

// Keeps the value of the first place and shuffles the others.
double by_shuffling(const PlacesOfOneTexel& texels, double sum, std::size_t neighbors) {
  constexpr int kTimes = 20000;
  std::vector<double> others(texels.values.begin() + 1, texels.values.end());
  const double expected = std::accumulate(others.begin(), others.end(), 0.0) /
                          static_cast<double>(others.size()) * static_cast<double>(neighbors);
  std::mt19937 random(2);
  int as_far = 1;
  for (int i = 0; i < kTimes; ++i) {
    std::ranges::shuffle(others, random);
    const double shuffled = std::accumulate(
        others.begin(), others.begin() + static_cast<std::ptrdiff_t>(neighbors), 0.0);
    as_far += std::abs(shuffled - expected) >= std::abs(sum - expected) ? 1 : 0;
  }
  return double(as_far) / (kTimes + 1);
}

TEST(PlacePermutations, give_the_chances_of_shuffled_values) {
  for (const std::size_t number : {std::size_t{60}, std::size_t{500}}) {
    const PlacesOfOneTexel texels(skewed_values(number));
    for (const std::size_t neighbors : {std::size_t{1}, std::size_t{4}, std::size_t{15}}) {
      const PlacePermutations permutations(texels.places, texels.areas, 15, 9999, Progress());
      const auto count = static_cast<double>(neighbors);
      for (const double off : {-1.5, -0.7, 0.1, 0.8, 1.6, 2.5}) {
        const double sum = count * texels.places.mean + off * std::sqrt(count);
        const double chance = double{permutations.chance(sum, count, texels.values.front())};
        EXPECT_NEAR(chance, by_shuffling(texels, sum, neighbors), 0.02)
            << number << ' ' << neighbors << ' ' << off;
      }
    }
  }
}

TEST(PlacePermutations, count_the_given_values_as_one_permutation) {
  const PlacesOfOneTexel texels(skewed_values(500));
  const PlacePermutations permutations(texels.places, texels.areas, 8, 199, Progress());
  EXPECT_FLOAT_EQ(permutations.chance(1000, 8, 1), 1.0f / 200);
  EXPECT_FLOAT_EQ(permutations.chance(-1000, 7.5, 1), 1.0f / 200);
  EXPECT_EQ(permutations.chance(8 * texels.places.mean, 8, texels.places.mean), 1);
}

TEST(PlacePermutations, of_parts_of_a_place_are_between_those_of_whole_places) {
  const PlacesOfOneTexel texels(skewed_values(500));
  const PlacePermutations permutations(texels.places, texels.areas, 15, 9999, Progress());
  // A sum of fewer values varies less, so the same distance is less likely.
  float before = 0;
  for (const double neighbors : {4.0, 4.5, 5.0, 5.5, 6.0, 9.0}) {
    const float chance =
        permutations.chance(neighbors * texels.places.mean + 3, neighbors, texels.places.mean);
    EXPECT_GT(chance, before) << neighbors;
    before = chance;
  }
}

TEST(PlacePermutations, are_1_without_neighbors_or_others) {
  const PlacesOfOneTexel texels(skewed_values(12));
  const PlacePermutations permutations(texels.places, texels.areas, 11, 99, Progress());
  EXPECT_EQ(permutations.chance(50, 0, 1), 1);
  EXPECT_EQ(permutations.chance(50, 11, 1), 1);
  EXPECT_LT(permutations.chance(50, 6, 1), 0.05);
  PlacesOfOneTexel same(skewed_values(12));
  same.places.deviation = 0;
  EXPECT_EQ(PlacePermutations(same.places, same.areas, 11, 99, Progress()).chance(50, 4, 1), 1);
}

TEST(PlacePermutations, do_not_shuffle_a_rare_value_of_the_place_itself) {
  for (const auto& [number, ones] : {std::pair(100, 3), std::pair(300, 6), std::pair(1000, 10)}) {
    std::vector<double> values(static_cast<std::size_t>(number));
    std::fill_n(values.begin(), ones, 1);
    const PlacesOfOneTexel texels(values);
    const PlacePermutations permutations(texels.places, texels.areas, 16, 9999, Progress());
    for (const double found : {1, 2})
      EXPECT_NEAR(double{permutations.chance(found, 16, 1)}, by_shuffling(texels, found, 16), 0.015)
          << number << ' ' << found;
  }
}

TEST(PlacePermutations, do_not_shuffle_an_outlier_of_the_place_itself) {
  for (const std::size_t number : {std::size_t{60}, std::size_t{200}}) {
    std::vector<double> values = skewed_values(number);
    values.front() = 30;
    const PlacesOfOneTexel texels(values);
    const PlacePermutations permutations(texels.places, texels.areas, 15, 9999, Progress());
    for (const double sum : {8.0, 15.0, 20.0, 26.0})
      EXPECT_NEAR(double{permutations.chance(sum, 15, 30)}, by_shuffling(texels, sum, 15), 0.015)
          << number << ' ' << sum;
  }
}

}  // namespace
}  // namespace strata::query
