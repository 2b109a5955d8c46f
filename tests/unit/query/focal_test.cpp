// Statistics of neighborhoods: brute force on a flat sheet with and without seams, and folds.
#include "query/regions/focal.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>
#include <random>
#include <set>
#include <vector>

#include "core/progress.h"
#include "query/regions/texel_discs.h"
#include "support/cut_shapes.h"
#include "support/cut_sheet.h"

namespace strata::query {
namespace {

using test::kSheetHeight;
using test::kSheetWidth;
using test::SheetCuts;
using test::Surface;

constexpr Focal kAll[] = {Focal::mean, Focal::min, Focal::max, Focal::variety};
using ValueAt = std::function<std::optional<float>(std::uint32_t)>;

SurfaceValues put(const Surface& surface, const ValueAt& value_at) {
  const std::size_t slots = surface.map.block_of_slot.size();
  SurfaceValues values{std::vector<std::uint32_t>(slots * 64), std::vector<std::uint64_t>(slots)};
  test::for_each_surface_texel(surface.map, [&](std::uint32_t texel) {
    if (const auto value = value_at(texel))
      values.set(texel, {std::bit_cast<std::uint32_t>(*value), true});
  });
  return values;
}

std::optional<float> number_at(const SurfaceValues& values, std::uint32_t texel) {
  const TexelValue value = values.of(texel);
  if (!value.valid) return std::nullopt;
  return std::bit_cast<float>(value.bits);
}

Result<SurfaceValues> compute(Focal statistic, const Surface& surface, const SurfaceValues& values,
                              double radius, int threads = 2) {
  Progress progress;
  return focal_values(statistic, values, ValueType::f32, radius, surface.map, surface.graph, "e",
                      progress, threads);
}

// The values of the sheet by column and row.
using Grid = std::vector<std::vector<std::optional<float>>>;

std::optional<float> by_brute_force(Focal statistic, const Grid& grid, glm::ivec2 at,
                                    double radius) {
  std::vector<float> found;
  const int reach = static_cast<int>(radius);
  for (int y = std::max(0, at.y - reach); y <= std::min(kSheetHeight - 1, at.y + reach); ++y)
    for (int x = std::max(0, at.x - reach); x <= std::min(kSheetWidth - 1, at.x + reach); ++x)
      if (std::hypot(x - at.x, y - at.y) <= radius && grid[std::size_t(y)][std::size_t(x)])
        found.push_back(*grid[std::size_t(y)][std::size_t(x)]);
  if (found.empty()) return std::nullopt;
  switch (statistic) {
    case Focal::mean: {
      double sum = 0;
      for (const float value : found) sum += double{value};
      return static_cast<float>(sum / double(found.size()));
    }
    case Focal::min: return *std::ranges::min_element(found);
    case Focal::max: return *std::ranges::max_element(found);
    case Focal::variety: break;
    case Focal::hot_spot: ADD_FAILURE() << "has a test of its own"; break;
  }
  return static_cast<float>(std::set(found.begin(), found.end()).size());
}

// A few classes, unpainted areas, and one value of another size.
Grid noisy_grid() {
  std::mt19937 random(3);
  Grid grid(kSheetHeight, std::vector<std::optional<float>>(kSheetWidth));
  for (int y = 0; y < kSheetHeight; ++y)
    for (int x = 0; x < kSheetWidth; ++x)
      if (x < 150 || random() % 50 == 0)
        grid[std::size_t(y)][std::size_t(x)] =
            static_cast<float>(random() % 7 + static_cast<unsigned>(x / 20));
  grid[40][20] = 1e30f;
  return grid;
}

TEST(Focal, equals_brute_force_on_a_sheet_with_and_without_seams) {
  const Grid grid = noisy_grid();
  for (const double radius : {0.0, 1.0, 2.5, 9.0})
    for (const Focal statistic : kAll) {
      std::map<std::pair<int, int>, std::optional<float>> expected;
      for (const SheetCuts& cuts :
           {SheetCuts{}, SheetCuts{{96}, {64}}, SheetCuts{{40, 96, 104, 152}, {24, 64}}}) {
        const Surface sheet = test::cut_sheet(cuts);
        const auto values = put(sheet, [&](std::uint32_t texel) {
          const glm::ivec2 at = test::sheet_place(sheet, texel);
          return grid[std::size_t(at.y)][std::size_t(at.x)];
        });
        const auto result = compute(statistic, sheet, values, radius);
        ASSERT_TRUE(result);
        test::for_each_surface_texel(sheet.map, [&](std::uint32_t texel) {
          const glm::ivec2 at = test::sheet_place(sheet, texel);
          auto [known, is_new] = expected.try_emplace({at.x, at.y});
          if (is_new) known->second = by_brute_force(statistic, grid, at, radius);
          const auto found = number_at(*result, texel);
          ASSERT_EQ(found.has_value(), known->second.has_value()) << at.x << ' ' << at.y;
          if (found) {
            ASSERT_NEAR(*found, *known->second, 1e-5f * std::abs(*known->second))
                << at.x << ' ' << at.y << " radius " << radius;
          }
        });
      }
    }
}

// A wall of two sides with a rim at s = 0.5, unfolded along s. Its values are 1 and 3 by side.
constexpr double kHeight = 1, kThickness = 0.02, kLength = 2 * kHeight + kThickness;
test::Shape wall() {
  return {202, 100,
          [](double s, double t) {
            const double along = s * kLength;
            if (along <= kHeight) return glm::dvec3(0, t, along);
            if (along < kHeight + kThickness) return glm::dvec3(along - kHeight, t, kHeight);
            return glm::dvec3(kThickness, t, kLength - along);
          },
          [](double s, double t) { return glm::dvec2(s * kLength, t); }};
}
double along_wall(glm::dvec3 p) {
  if (p.z >= kHeight - 1e-6) return kHeight + p.x;
  return p.x < kThickness / 2 ? p.z : kLength - p.z;
}

TEST(Focal, does_not_reach_through_a_wall_or_far_around_its_rim) {
  // One chart, and charts whose seams are near all texels.
  for (const test::Cuts cuts : {test::Cuts{1, 1, 0, 1}, test::Cuts{20, 10, 0, 1}}) {
    const Surface surface = test::cut_surface(wall(), cuts, 256);
    const auto along = [&](std::uint32_t texel) {
      return along_wall(surface.geometry.origin +
                        glm::dvec3(surface.map.position(texel / 64, int(texel % 64))));
    };
    const auto values = put(surface, [&](std::uint32_t texel) {
      return std::optional(along(texel) < kLength / 2 ? 1.0f : 3.0f);
    });
    const double radius = 12 * mean_texel_size(surface.map);
    ASSERT_GT(radius, 2 * kThickness);
    const auto means = compute(Focal::mean, surface, values, radius);
    ASSERT_TRUE(means);
    int near = 0;
    test::for_each_surface_texel(surface.map, [&](std::uint32_t texel) {
      const glm::vec3 p = surface.map.position(texel / 64, int(texel % 64));
      const double t = double{p.y} + surface.geometry.origin.y;
      const double beyond = std::abs(along(texel) - kLength / 2) / radius;
      if (t < radius || t > 1 - radius) return;
      // The part of a disc beyond a straight line.
      const double share =
          beyond >= 1
              ? 0
              : (std::acos(beyond) - beyond * std::sqrt(1 - beyond * beyond)) / std::numbers::pi;
      const double right = along(texel) < kLength / 2 ? 1 + 2 * share : 3 - 2 * share;
      near += share > 0;
      ASSERT_NEAR(*number_at(*means, texel), right, 0.25) << beyond << " at " << t;
    });
    EXPECT_GT(near, 1000);
  }
}

TEST(Focal, weighs_the_mean_by_area) {
  // Texels of a chart with a smaller scale are larger on the surface.
  const test::Shape sheet{64, 64, [](double s, double t) { return glm::dvec3(s, t, 0); },
                          [](double s, double t) { return glm::dvec2(s, t); }};
  const Surface surface = test::cut_surface(sheet, {2, 1, 0, 0.5}, 512);
  const auto values = put(surface, [&](std::uint32_t texel) {
    return std::optional(
        surface.map.position(texel / 64, int(texel % 64)).x + surface.geometry.origin.x < 0.5
            ? 0.0f
            : 1.0f);
  });
  const double radius = 20 * mean_texel_size(surface.map);
  const auto means = compute(Focal::mean, surface, values, radius);
  ASSERT_TRUE(means);
  test::for_each_surface_texel(surface.map, [&](std::uint32_t texel) {
    const glm::dvec3 p =
        surface.geometry.origin + glm::dvec3(surface.map.position(texel / 64, int(texel % 64)));
    if (std::abs(p.x - 0.5) > radius / 20 || std::abs(p.y - 0.5) > 0.5 - radius) return;
    EXPECT_NEAR(*number_at(*means, texel), 0.5, 0.06);
  });
}

// The formula of Getis and Ord, with discs as places.
std::vector<std::vector<float>> scores_by_brute_force(const Grid& grid, int radius) {
  const auto disc = [&](int x, int y, double reach) {
    double area = 0, weighted = 0;
    for (int v = std::max(0, y - int(reach)); v <= std::min(kSheetHeight - 1, y + int(reach)); ++v)
      for (int u = std::max(0, x - int(reach)); u <= std::min(kSheetWidth - 1, x + int(reach)); ++u)
        if (const auto& value = grid[std::size_t(v)][std::size_t(u)];
            value && std::hypot(u - x, v - y) <= reach) {
          area += 1;
          weighted += double{*value};
        }
    return std::pair(area, weighted / area);
  };
  double area = 0, sum = 0, squares = 0, of_places = 0;
  for (int y = 0; y < kSheetHeight; ++y)
    for (int x = 0; x < kSheetWidth; ++x) {
      if (!grid[std::size_t(y)][std::size_t(x)]) continue;
      const auto [of_place, mean] = disc(x, y, radius / 4.0);
      area += 1;
      sum += mean;
      squares += mean * mean;
      of_places += of_place;
    }
  const double mean = sum / area, deviation = std::sqrt(squares / area - mean * mean),
               of_place = of_places / area, number = area / of_place;
  std::vector<std::vector<float>> scores(kSheetHeight, std::vector<float>(kSheetWidth));
  for (int y = 0; y < kSheetHeight; ++y)
    for (int x = 0; x < kSheetWidth; ++x) {
      const auto [within_area, within_mean] = disc(x, y, radius);
      const double within = within_area / of_place;
      scores[std::size_t(y)][std::size_t(x)] = static_cast<float>(
          (within * (within_mean - mean)) /
          (deviation * std::sqrt((number * within - within * within) / (number - 1))));
    }
  return scores;
}

TEST(HotSpots, equal_the_formula_of_getis_and_ord_with_and_without_seams) {
  Grid grid = noisy_grid();
  grid[40][20] = 5;
  const auto right = scores_by_brute_force(grid, 12);
  for (const SheetCuts& cuts : {SheetCuts{}, SheetCuts{{96}, {64}}}) {
    const Surface sheet = test::cut_sheet(cuts);
    const auto values = put(sheet, [&](std::uint32_t texel) {
      const glm::ivec2 at = test::sheet_place(sheet, texel);
      return grid[std::size_t(at.y)][std::size_t(at.x)];
    });
    const auto scores = compute(Focal::hot_spot, sheet, values, 12);
    ASSERT_TRUE(scores);
    double least = 0, most = 0;
    test::for_each_surface_texel(sheet.map, [&](std::uint32_t texel) {
      const glm::ivec2 at = test::sheet_place(sheet, texel);
      const auto score = number_at(*scores, texel);
      if (!score) return;
      least = std::min(least, double{*score});
      most = std::max(most, double{*score});
      ASSERT_NEAR(*score, right[std::size_t(at.y)][std::size_t(at.x)], 2e-3) << at.x << ' ' << at.y;
    });
    EXPECT_LT(least, -1);
    EXPECT_GT(most, 1);
  }
}

// A plane of one unit, with values at its texels.
Surface plane(int resolution, const test::Cuts& cuts = {}) {
  const test::Shape shape{64, 64, [](double s, double t) { return glm::dvec3(s, t, 0); },
                          [](double s, double t) { return glm::dvec2(s, t); }};
  return test::cut_surface(shape, cuts, resolution);
}
glm::dvec2 on_plane(const Surface& surface, std::uint32_t texel) {
  return glm::dvec2(surface.geometry.origin +
                    glm::dvec3(surface.map.position(texel / 64, int(texel % 64))));
}

constexpr double kPlanted = 0.06;  // radius
constexpr glm::dvec2 kHot(0.3, 0.6), kCold(0.7, 0.35);

// Noise with a cluster of higher and one of lower values.
SurfaceValues planted_clusters(const Surface& surface) {
  std::mt19937 random(5);
  std::normal_distribution<float> noise(0, 1);
  return put(surface, [&](std::uint32_t texel) {
    const glm::dvec2 at = on_plane(surface, texel);
    const float planted = glm::distance(at, kHot) < kPlanted    ? 0.5f
                          : glm::distance(at, kCold) < kPlanted ? -0.5f
                                                                : 0;
    return std::optional(10 + noise(random) + planted);
  });
}

TEST(HotSpots, find_planted_clusters_and_little_else) {
  const Surface surface = plane(512);
  const double radius = kPlanted;
  const glm::dvec2 hot = kHot, cold = kCold;
  const auto values = planted_clusters(surface);
  const auto scores = compute(Focal::hot_spot, surface, values, radius);
  ASSERT_TRUE(scores);
  double elsewhere = 0, flagged = 0, hottest = 0, coldest = 0;
  glm::dvec2 hottest_at{}, coldest_at{};
  test::for_each_surface_texel(surface.map, [&](std::uint32_t texel) {
    const glm::dvec2 at = on_plane(surface, texel);
    const double score = double{*number_at(*scores, texel)};
    if (score > hottest) hottest = score, hottest_at = at;
    if (score < coldest) coldest = score, coldest_at = at;
    if (glm::distance(at, hot) < 2 * radius || glm::distance(at, cold) < 2 * radius) return;
    elsewhere += 1;
    flagged += std::abs(score) > 2.58 ? 1 : 0;
  });
  EXPECT_LT(glm::distance(hottest_at, hot), radius / 2);
  EXPECT_LT(glm::distance(coldest_at, cold), radius / 2);
  EXPECT_GT(hottest, 4);
  EXPECT_LT(coldest, -4);
  EXPECT_LT(flagged / elsewhere, 0.03);  // 0.01 of independent places
}

TEST(HotSpots, of_noise_have_a_standard_normal_distribution) {
  const Surface surface = plane(512);
  double sum = 0, squares = 0, count = 0, flagged = 0;
  for (const unsigned seed : {1u, 2u, 3u}) {
    std::mt19937 random(seed);
    std::exponential_distribution<float> noise(1);  // skewed
    const auto values = put(surface, [&](std::uint32_t) { return std::optional(noise(random)); });
    const auto scores = compute(Focal::hot_spot, surface, values, 0.05);
    ASSERT_TRUE(scores);
    test::for_each_surface_texel(surface.map, [&](std::uint32_t texel) {
      const double score = double{*number_at(*scores, texel)};
      sum += score;
      squares += score * score;
      count += 1;
      flagged += std::abs(score) > 1.96 ? 1 : 0;
    });
  }
  EXPECT_NEAR(sum / count, 0, 0.1);
  EXPECT_NEAR(std::sqrt(squares / count), 1, 0.1);
  EXPECT_NEAR(flagged / count, 0.05, 0.02);
}

TEST(HotSpots, are_the_same_at_other_resolutions_and_with_other_charts) {
  const auto value_at = [](glm::dvec2 at) {
    return static_cast<float>(std::sin(17 * at.x) * std::cos(23 * at.y) + std::sin(5 * at.y));
  };
  std::vector<std::map<std::pair<int, int>, std::pair<double, int>>> found;
  for (const auto& [resolution, cuts] :
       {std::pair(256, test::Cuts{1, 1, 0, 1}), std::pair(512, test::Cuts{1, 1, 0, 1}),
        std::pair(512, test::Cuts{3, 3})}) {
    const Surface surface = plane(resolution, cuts);
    const auto values = put(surface, [&](std::uint32_t texel) {
      return std::optional(value_at(on_plane(surface, texel)));
    });
    const auto scores = compute(Focal::hot_spot, surface, values, 0.06);
    ASSERT_TRUE(scores) << scores.error().detail;
    auto& means = found.emplace_back();  // of squares on the plane
    test::for_each_surface_texel(surface.map, [&](std::uint32_t texel) {
      const glm::dvec2 at = on_plane(surface, texel);
      auto& [sum, count] = means[{int(at.x * 20), int(at.y * 20)}];
      sum += double{*number_at(*scores, texel)};
      ++count;
    });
  }
  double squares = 0;
  for (const auto& [square, first] : found[0]) squares += std::pow(first.first / first.second, 2);
  for (const std::size_t other : {std::size_t{1}, std::size_t{2}}) {
    double off = 0;
    for (const auto& [square, first] : found[0]) {
      const auto& [sum, count] = found[other].at(square);
      off += std::pow(first.first / first.second - sum / count, 2);
    }
    EXPECT_LT(std::sqrt(off / squares), 0.05) << other;
  }
}

TEST(HotSpots, of_equal_values_are_0_despite_rounding) {
  // The areas of the texels and their sums are rounded.
  const test::Shape tube{
      64, 64,
      [](double s, double t) { return glm::dvec3(std::cos(5 * s), std::sin(5 * s), 3 * t); },
      [](double s, double t) { return glm::dvec2(5 * s, 3 * t); }};
  const Surface surface = test::cut_surface(tube, {2, 2}, 256);
  const auto values = put(surface, [](std::uint32_t) { return std::optional(0.1f); });
  const auto scores = compute(Focal::hot_spot, surface, values, 12 * mean_texel_size(surface.map));
  ASSERT_TRUE(scores);
  test::for_each_surface_texel(
      surface.map, [&](std::uint32_t texel) { ASSERT_EQ(number_at(*scores, texel), 0); });
}

TEST(HotSpots, are_0_where_no_place_stands_out) {
  const Surface sheet = test::cut_sheet();
  const auto same = put(sheet, [](std::uint32_t) { return std::optional(3.0f); });
  const auto one = put(sheet, [&](std::uint32_t texel) {
    const glm::ivec2 at = test::sheet_place(sheet, texel);
    return at == glm::ivec2(50, 50) ? std::optional(3.0f) : std::nullopt;
  });
  const auto none = put(sheet, [](std::uint32_t) { return std::nullopt; });
  for (const auto& [values, known] :
       {std::pair(same, kSheetWidth * kSheetHeight), std::pair(one, 317), std::pair(none, 0)}) {
    const auto scores = compute(Focal::hot_spot, sheet, values, 10);
    ASSERT_TRUE(scores);
    int count = 0;
    test::for_each_surface_texel(sheet.map, [&](std::uint32_t texel) {
      const auto score = number_at(*scores, texel);
      if (!score) return;
      ++count;
      ASSERT_EQ(*score, 0);
    });
    EXPECT_EQ(count, known);
  }
}

SurfaceValues chances_of(const Surface& surface, const SurfaceValues& values, double radius,
                         int permutations = 999, int threads = 2) {
  Progress progress;
  auto chances = hot_spot_chances(values, ValueType::f32, radius, permutations, surface.map,
                                  surface.graph, "e", progress, threads);
  EXPECT_TRUE(chances);
  return std::move(*chances);
}

TEST(HotSpotChances, find_planted_clusters_and_little_else) {
  const Surface surface = plane(512);
  const double radius = kPlanted;
  const glm::dvec2 hot = kHot, cold = kCold;
  const auto chances = chances_of(surface, planted_clusters(surface), radius);
  double elsewhere = 0, flagged = 0;
  test::for_each_surface_texel(surface.map, [&](std::uint32_t texel) {
    const glm::dvec2 at = on_plane(surface, texel);
    const double chance = double{*number_at(chances, texel)};
    const double to_planted = std::min(glm::distance(at, hot), glm::distance(at, cold));
    if (to_planted < radius / 2) {
      EXPECT_NEAR(chance, 0.001, 1e-6) << at.x << ' ' << at.y;  // 1 / (999 + 1)
    }
    if (to_planted < 2 * radius) return;
    elsewhere += 1;
    flagged += chance < 0.01 ? 1 : 0;
  });
  EXPECT_LT(flagged / elsewhere, 0.03);  // 0.01 of independent places
}

TEST(HotSpotChances, of_noise_are_evenly_distributed) {
  const Surface surface = plane(512);
  for (const bool is_skewed : {false, true}) {
    double count = 0, sum = 0, below_5 = 0, below_20 = 0;
    for (const unsigned seed : {1u, 2u, 3u}) {
      std::mt19937 random(seed);
      std::normal_distribution<float> normal(0, 1);
      std::exponential_distribution<float> skewed(1);
      const auto values = put(surface, [&](std::uint32_t) {
        return std::optional(is_skewed ? skewed(random) : normal(random));
      });
      const auto chances = chances_of(surface, values, 0.05);
      test::for_each_surface_texel(surface.map, [&](std::uint32_t texel) {
        const double chance = double{*number_at(chances, texel)};
        count += 1;
        sum += chance;
        below_5 += chance < 0.05 ? 1 : 0;
        below_20 += chance < 0.2 ? 1 : 0;
      });
    }
    EXPECT_NEAR(sum / count, 0.5, 0.04) << is_skewed;
    EXPECT_NEAR(below_5 / count, 0.05, 0.02) << is_skewed;
    EXPECT_NEAR(below_20 / count, 0.2, 0.05) << is_skewed;
  }
}

TEST(HotSpotChances, are_1_where_nothing_can_be_shuffled) {
  const Surface sheet = test::cut_sheet();
  const auto same = put(sheet, [](std::uint32_t) { return std::optional(3.0f); });
  const auto one = put(sheet, [&](std::uint32_t texel) {
    const glm::ivec2 at = test::sheet_place(sheet, texel);
    return at == glm::ivec2(50, 50) ? std::optional(3.0f) : std::nullopt;
  });
  for (const auto& [values, known] :
       {std::pair(same, kSheetWidth * kSheetHeight), std::pair(one, 317)}) {
    const auto chances = chances_of(sheet, values, 10, 99);
    int count = 0;
    test::for_each_surface_texel(sheet.map, [&](std::uint32_t texel) {
      const auto chance = number_at(chances, texel);
      if (!chance) return;
      ++count;
      ASSERT_EQ(*chance, 1);
    });
    EXPECT_EQ(count, known);
  }
}

TEST(HotSpotChances, are_the_same_each_time_and_with_other_charts) {
  const auto value_at = [](glm::dvec2 at) {
    return static_cast<float>(std::sin(67 * at.x) * std::cos(73 * at.y));
  };
  std::vector<std::map<std::pair<int, int>, std::pair<double, int>>> found;
  for (const test::Cuts& cuts : {test::Cuts{1, 1, 0, 1}, test::Cuts{3, 3}}) {
    const Surface surface = plane(512, cuts);
    const auto values = put(surface, [&](std::uint32_t texel) {
      return std::optional(value_at(on_plane(surface, texel)));
    });
    const auto chances = chances_of(surface, values, 0.06, 999, 1);
    EXPECT_EQ(chances.bits, chances_of(surface, values, 0.06, 999, 3).bits);
    auto& means = found.emplace_back();  // of squares on the plane
    test::for_each_surface_texel(surface.map, [&](std::uint32_t texel) {
      const glm::dvec2 at = on_plane(surface, texel);
      auto& [sum, count] = means[{int(at.x * 20), int(at.y * 20)}];
      sum += double{*number_at(chances, texel)};
      ++count;
    });
  }
  for (const auto& [square, first] : found[0]) {
    const auto& [sum, count] = found[1].at(square);
    EXPECT_NEAR(first.first / first.second, sum / count, 0.1);
  }
}

TEST(HotSpotChances, refuse_a_radius_of_more_than_40_texels_and_can_be_cancelled) {
  const Surface sheet = test::cut_sheet();
  const auto values = put(sheet, [](std::uint32_t texel) { return std::optional(float(texel)); });
  Progress progress;
  const auto refused =
      hot_spot_chances(values, ValueType::f32, 40.1, 99, sheet.map, sheet.graph, "e", progress);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().field, "e");
  progress.cancel();
  EXPECT_EQ(hot_spot_chances(values, ValueType::f32, 5, 99, sheet.map, sheet.graph, "e", progress)
                .error()
                .code,
            ErrorCode::cancelled);
}

TEST(Focal, does_not_depend_on_threads_and_can_be_cancelled) {
  const Surface sheet = test::cut_sheet({{96}, {64}});
  const Grid grid = noisy_grid();
  const auto values = put(sheet, [&](std::uint32_t texel) {
    const glm::ivec2 at = test::sheet_place(sheet, texel);
    return grid[std::size_t(at.y)][std::size_t(at.x)];
  });
  for (const Focal statistic :
       {Focal::mean, Focal::min, Focal::max, Focal::variety, Focal::hot_spot})
    EXPECT_EQ(compute(statistic, sheet, values, 5, 1)->bits,
              compute(statistic, sheet, values, 5, 4)->bits);
  Progress progress;
  progress.cancel();
  EXPECT_EQ(
      focal_values(Focal::mean, values, ValueType::f32, 5, sheet.map, sheet.graph, "e", progress)
          .error()
          .code,
      ErrorCode::cancelled);
}

TEST(Focal, refuses_a_radius_of_more_than_40_texels) {
  const Surface sheet = test::cut_sheet({});
  const auto values = put(sheet, [](std::uint32_t) { return std::optional(1.0f); });
  for (const double radius : {40.1, 1e300, std::numeric_limits<double>::quiet_NaN()}) {
    const auto refused = compute(Focal::max, sheet, values, radius);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().field, "e");
    EXPECT_THAT(refused.error().detail, testing::HasSubstr("40 texels"));
  }
}

}  // namespace
}  // namespace strata::query
