// Hysteresis: a brute force flood on a flat sheet with and without seams.
#include "query/regions/hysteresis.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "core/progress.h"
#include "support/cut_sheet.h"

namespace strata::query {
namespace {

using test::kSheetHeight;
using test::kSheetWidth;
using test::SheetCuts;
using test::Surface;

constexpr float kNoValue = std::numeric_limits<float>::quiet_NaN();
using Grid = std::vector<std::vector<float>>;

SurfaceValues put(const Surface& sheet, const Grid& grid) {
  const std::size_t slots = sheet.map.block_of_slot.size();
  SurfaceValues values{std::vector<std::uint32_t>(slots * 64), std::vector<std::uint64_t>(slots)};
  test::for_each_surface_texel(sheet.map, [&](std::uint32_t texel) {
    const glm::ivec2 at = test::sheet_place(sheet, texel);
    const float value = grid[std::size_t(at.y)][std::size_t(at.x)];
    values.set(texel, {std::bit_cast<std::uint32_t>(value), !std::isnan(value)});
  });
  return values;
}

// Floods from each place above the high threshold over its eight neighbors.
std::vector<std::vector<bool>> flooded(const Grid& grid, const Thresholds& thresholds) {
  std::vector<std::vector<bool>> reached(kSheetHeight, std::vector<bool>(kSheetWidth));
  std::vector<glm::ivec2> open;
  const auto visit = [&](int x, int y, double above) {
    if (x < 0 || y < 0 || x >= kSheetWidth || y >= kSheetHeight) return;
    if (reached[std::size_t(y)][std::size_t(x)] ||
        !(double{grid[std::size_t(y)][std::size_t(x)]} > above))
      return;
    reached[std::size_t(y)][std::size_t(x)] = true;
    open.emplace_back(x, y);
  };
  for (int y = 0; y < kSheetHeight; ++y)
    for (int x = 0; x < kSheetWidth; ++x) visit(x, y, thresholds.high);
  while (!open.empty()) {
    const glm::ivec2 at = open.back();
    open.pop_back();
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) visit(at.x + dx, at.y + dy, thresholds.low);
  }
  return reached;
}

Grid random_grid(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> number(0, 1);
  Grid grid(kSheetHeight, std::vector<float>(kSheetWidth));
  for (auto& row : grid)
    for (float& value : row) value = random() % 20 == 0 ? kNoValue : number(random);
  return grid;
}

TEST(Hysteresis, equals_a_flood_with_and_without_seams) {
  const Surface sheets[] = {test::cut_sheet(), test::cut_sheet({{96}, {64}}),
                            test::cut_sheet({{40, 96, 104, 152}, {24, 64}}),
                            test::cut_sheet({{96}, {}, 90})};
  // With these thresholds, many pieces hold together at corners only.
  for (const Thresholds thresholds : {Thresholds{0.65, 0.99}, Thresholds{0.5, 0.999}})
    for (unsigned seed = 1; seed <= 3; ++seed) {
      const Grid grid = random_grid(seed);
      const auto expected = flooded(grid, thresholds);
      for (const Surface& sheet : sheets) {
        Progress progress;
        const auto result = hysteresis_values(put(sheet, grid), ValueType::f32, thresholds,
                                              sheet.map, sheet.graph, progress);
        ASSERT_TRUE(result);
        int inside = 0, outside = 0;
        test::for_each_surface_texel(sheet.map, [&](std::uint32_t texel) {
          const glm::ivec2 at = test::sheet_place(sheet, texel);
          const TexelValue found = result->of(texel);
          ASSERT_EQ(found.valid, expected[std::size_t(at.y)][std::size_t(at.x)])
              << at.x << ' ' << at.y;
          if (found.valid) {
            ASSERT_EQ(std::bit_cast<float>(found.bits), 1);
          }
          ++(found.valid ? inside : outside);
        });
        EXPECT_GT(inside, 500);
        EXPECT_GT(outside, 500);
      }
    }
}

TEST(Hysteresis, keeps_only_pieces_with_a_place_above_the_high_threshold) {
  Grid grid(kSheetHeight, std::vector<float>(kSheetWidth, 0));
  for (int x = 10; x < 60; ++x) grid[20][std::size_t(x)] = grid[60][std::size_t(x)] = 0.5f;
  grid[20][30] = 0.9f;
  grid[60][30] = 0.75f;  // not above
  const Surface sheet = test::cut_sheet();
  Progress progress;
  const auto result = hysteresis_values(put(sheet, grid), ValueType::f32, {0.4, 0.75}, sheet.map,
                                        sheet.graph, progress);
  ASSERT_TRUE(result);
  test::for_each_surface_texel(sheet.map, [&](std::uint32_t texel) {
    const glm::ivec2 at = test::sheet_place(sheet, texel);
    ASSERT_EQ(result->of(texel).valid, at.y == 20 && at.x >= 10 && at.x < 60);
  });
}

TEST(Hysteresis, can_be_cancelled) {
  const Surface sheet = test::cut_sheet();
  Progress progress;
  progress.cancel();
  EXPECT_EQ(hysteresis_values(put(sheet, random_grid(1)), ValueType::f32, {0.5, 0.9}, sheet.map,
                              sheet.graph, progress)
                .error()
                .code,
            ErrorCode::cancelled);
}

}  // namespace
}  // namespace strata::query
