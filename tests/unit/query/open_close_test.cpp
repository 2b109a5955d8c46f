// Opening and closing: brute force on a grid, shapes with known areas, and the same with seams.
#include "query/regions/open_close.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "core/progress.h"
#include "support/cut_sheet.h"

namespace strata::query {
namespace {

using test::kSheetHeight;
using test::kSheetWidth;
using test::Surface;
using Grid = std::vector<std::vector<int>>;  // by row and column; 0: no value
using ValueAt = std::function<int(int, int)>;
constexpr double kPi = std::numbers::pi;

Grid grid_of(const ValueAt& value_at) {
  Grid grid(kSheetHeight, std::vector<int>(kSheetWidth));
  for (int y = 0; y < kSheetHeight; ++y)
    for (int x = 0; x < kSheetWidth; ++x) grid[std::size_t(y)][std::size_t(x)] = value_at(x, y);
  return grid;
}
int at(const Grid& grid, int x, int y) { return grid[std::size_t(y)][std::size_t(x)]; }

const std::vector<Surface>& sheets() {
  static const std::vector<Surface> made = [] {
    std::vector<Surface> all;
    for (const test::SheetCuts& cuts :
         {test::SheetCuts{}, test::SheetCuts{{96}, {64}}, test::SheetCuts{{96}, {}, 90}})
      all.push_back(test::cut_sheet(cuts));
    return all;
  }();
  return made;
}

enum class Which { open, close };

Grid computed(const Surface& sheet, Which which, const Grid& grid, double radius) {
  const std::size_t slots = sheet.map.block_of_slot.size();
  SurfaceValues values{std::vector<std::uint32_t>(slots * 64), std::vector<std::uint64_t>(slots)};
  test::for_each_surface_texel(sheet.map, [&](std::uint32_t texel) {
    const glm::ivec2 place = test::sheet_place(sheet, texel);
    const int value = at(grid, place.x, place.y);
    values.set(texel, {static_cast<std::uint32_t>(value), value != 0});
  });
  Progress progress;
  const auto after = (which == Which::open ? open_value : close_value)(
      std::move(values), 1, radius, sheet.map, sheet.graph, progress, 2);
  Grid result(kSheetHeight, std::vector<int>(kSheetWidth, -1));
  test::for_each_surface_texel(sheet.map, [&](std::uint32_t texel) {
    const glm::ivec2 place = test::sheet_place(sheet, texel);
    result[std::size_t(place.y)][std::size_t(place.x)] = static_cast<int>(after->of(texel).bits);
  });
  return result;
}

// Sets of cells, as grids of 0 and 1.
Grid dilated(const Grid& set, double radius) {
  const int reach = static_cast<int>(radius);
  return grid_of([&](int x, int y) {
    for (int dy = -reach; dy <= reach; ++dy)
      for (int dx = -reach; dx <= reach; ++dx)
        if (dx * dx + dy * dy <= radius * radius && x + dx >= 0 && x + dx < kSheetWidth &&
            y + dy >= 0 && y + dy < kSheetHeight && at(set, x + dx, y + dy) == 1)
          return 1;
    return 0;
  });
}
Grid inverse(const Grid& set) {
  return grid_of([&](int x, int y) { return at(set, x, y) == 1 ? 0 : 1; });
}
Grid eroded(const Grid& set, double radius) { return inverse(dilated(inverse(set), radius)); }

// The computed distances are exact but for this many texels, so the result is between two limits.
constexpr double kError = 0.35;

TEST(OpenClose, are_those_of_a_disc_of_texels_with_and_without_seams) {
  const Grid patches = grid_of([](int x, int y) {
    return std::sin(x * 0.13 + y * 0.05) * std::cos(y * 0.21) + 0.3 * std::sin(x * 0.9) > 0 ? 1 : 0;
  });
  for (const double radius : {1.5, 3.0, 6.2}) {
    const double less = radius - kError, more = radius + kError;
    const Grid least_open = dilated(eroded(patches, more), less),
               most_open = dilated(eroded(patches, less), more),
               least_closed = eroded(dilated(patches, less), more),
               most_closed = eroded(dilated(patches, more), less);
    for (std::size_t i = 0; i < sheets().size(); ++i) {
      SCOPED_TRACE("sheet " + std::to_string(i) + " radius " + std::to_string(radius));
      const Grid open = computed(sheets()[i], Which::open, patches, radius),
                 closed = computed(sheets()[i], Which::close, patches, radius);
      int wrong = 0, changed = 0;
      for (int y = 0; y < kSheetHeight; ++y)
        for (int x = 0; x < kSheetWidth; ++x) {
          const int before = at(patches, x, y), o = at(open, x, y), c = at(closed, x, y);
          EXPECT_TRUE(o <= before && before <= c);
          wrong += o < std::min(before, at(least_open, x, y)) || o > at(most_open, x, y);
          wrong += c < at(least_closed, x, y) || c > std::max(before, at(most_closed, x, y));
          changed += (o != before) + (c != before);
        }
      // At seams, the distances of single texels have larger errors.
      EXPECT_LE(wrong, (i == 0 ? 0.01 : 0.04) * changed);
      EXPECT_GT(changed, 100);
    }
  }
}

int count(const Grid& grid, int value) {
  int sum = 0;
  for (const auto& row : grid) sum += static_cast<int>(std::ranges::count(row, value));
  return sum;
}

TEST(OpenClose, opening_removes_a_strip_and_rounds_corners) {
  // A rectangle of 80 × 60 over the seams, a strip of 6 to the right, and a disc on value 2.
  const Grid grid = grid_of([](int x, int y) {
    if (x >= 60 && x < 140 && y >= 30 && y < 90) return 1;
    if (x >= 140 && x < 180 && y >= 60 && y < 66) return 1;
    if (std::hypot(x - 30, y - 60) < 20) return std::abs(x - 30) < 2 ? 1 : 2;
    return 0;
  });
  for (const Surface& sheet : sheets()) {
    const Grid open = computed(sheet, Which::open, grid, 5);
    EXPECT_NEAR(count(open, 1), 80 * 60 - (4 - kPi) * 25, 16);
    EXPECT_EQ(at(open, 170, 63), 0);  // the strip gets the value around it
    EXPECT_EQ(at(open, 30, 60), 2);   // the line on the disc too
    EXPECT_EQ(at(computed(sheet, Which::open, grid, 2.4), 170, 63), 1);
  }
}

TEST(OpenClose, closing_fills_a_gap_whatever_value_it_has) {
  // Two rectangles of 40 × 60 with a gap of 8 at the seam, whose upper half has value 3.
  const Grid grid = grid_of([](int x, int y) {
    if (y < 30 || y >= 90 || x < 52 || x >= 140) return 0;
    return x < 92 || x >= 100 ? 1 : y >= 60 ? 3 : 0;
  });
  for (const Surface& sheet : sheets()) {
    const Grid closed = computed(sheet, Which::close, grid, 6);
    // At both ends of the gap, the disc of 6 reaches into it until it touches both corners.
    const double segment = 36 * std::asin(4 / 6.0) - 4 * std::sqrt(36.0 - 16.0);
    EXPECT_NEAR(count(closed, 1), 88 * 60 - 2 * segment, 16);
    EXPECT_EQ(at(closed, 96, 75), 1);
    EXPECT_EQ(at(closed, 96, 45), 1);
    EXPECT_EQ(at(computed(sheet, Which::close, grid, 3), 96, 45), 0);
    EXPECT_EQ(at(closed, 30, 60), 0);
  }
}

TEST(OpenClose, nothing_and_everything_stay) {
  for (const int value : {0, 1, 2}) {
    const Grid grid = grid_of([&](int, int) { return value; });
    for (const Which which : {Which::open, Which::close})
      EXPECT_EQ(computed(sheets().back(), which, grid, 4), grid);
  }
}

TEST(OpenClose, stop_when_cancelled) {
  const Surface& sheet = sheets().front();
  const std::size_t slots = sheet.map.block_of_slot.size();
  Progress progress;
  progress.cancel();
  const SurfaceValues values{std::vector<std::uint32_t>(slots * 64, 1),
                             std::vector<std::uint64_t>(slots, 0xffff)};
  for (const auto& run : {open_value, close_value}) {
    const auto after = run(values, 1, 3, sheet.map, sheet.graph, progress, 1);
    ASSERT_FALSE(after);
    EXPECT_EQ(after.error().code, ErrorCode::cancelled);
  }
}

}  // namespace
}  // namespace strata::query
