// Views on a sheet: their grid, their common scale and their places in whole pixels.
#include "figure/view_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "figure/drawing.h"
#include "figure/layout.h"

namespace strata::figure {
namespace {

const Box kArea{{10, 20}, {190, 250}};
constexpr ViewSpacing kSpacing{4, 11};

void expect_apart_and_inside(const ViewGrid& grid, const Box& area, const ViewSpacing& spacing) {
  for (std::size_t i = 0; i < grid.boxes.size(); ++i) {
    const Box& box = grid.boxes[i];
    const glm::dvec2 end = box.corner + box.size;
    EXPECT_GE(box.corner.x, area.corner.x - 1e-9);
    EXPECT_GE(box.corner.y, area.corner.y - 1e-9);
    EXPECT_LE(end.x, area.corner.x + area.size.x + 1e-9);
    EXPECT_LE(end.y + spacing.below_mm, area.corner.y + area.size.y + 1e-9);
    for (std::size_t j = 0; j < i; ++j) {
      const Box& other = grid.boxes[j];
      const glm::dvec2 other_end = other.corner + other.size;
      EXPECT_TRUE(other_end.x + spacing.gap_mm <= box.corner.x + 1e-9 ||
                  other_end.y + spacing.below_mm + spacing.gap_mm <= box.corner.y + 1e-9 ||
                  end.x + spacing.gap_mm <= other.corner.x + 1e-9 ||
                  end.y + spacing.below_mm + spacing.gap_mm <= other.corner.y + 1e-9)
          << i << " and " << j;
    }
  }
}

TEST(ViewGrid, TheCommonScaleIsTheLargestRoundOneAtWhichAllViewsFit) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> length(5, 4000);
  for (int round = 0; round < 200; ++round) {
    std::vector<ViewSize> views;
    const int count = 2 + round % 5;
    for (int i = 0; i < count; ++i) views.push_back({{length(random), length(random)}, {}, {}});
    const ViewGrid grid = arrange_views(views, kArea, kSpacing, std::nullopt);
    ASSERT_EQ(grid.boxes.size(), views.size());
    EXPECT_LE(grid.tightness, 1);
    expect_apart_and_inside(grid, kArea, kSpacing);
    for (std::size_t i = 0; i < views.size(); ++i) {
      EXPECT_LE(views[i].life_mm.x / grid.scale, grid.boxes[i].size.x + 1e-9);
      EXPECT_LE(views[i].life_mm.y / grid.scale, grid.boxes[i].size.y + 1e-9);
    }
    // no grid fits at the next larger scale
    const auto scales = round_scales();
    const auto at = std::ranges::find(scales, grid.scale);
    ASSERT_NE(at, scales.end());
    if (at != scales.begin()) {
      EXPECT_GT(arrange_views(views, kArea, kSpacing, *(at - 1)).tightness, 1);
    }
  }
}

TEST(ViewGrid, TheNumberOfColumnsFitsTheShapeOfTheViews) {
  const auto columns_of = [](const glm::dvec2& size, std::size_t count) {
    const ViewGrid grid = arrange_views(std::vector<ViewSize>(count, ViewSize{size, {}, {}}), kArea,
                                        kSpacing, std::nullopt);
    return std::ranges::count_if(
        grid.boxes, [&](const Box& box) { return box.corner.y == grid.boxes[0].corner.y; });
  };
  EXPECT_EQ(columns_of({10, 400}, 2), 2);   // columns side by side
  EXPECT_EQ(columns_of({400, 100}, 2), 1);  // walls one above the other
  EXPECT_EQ(columns_of({400, 400}, 4), 2);
  EXPECT_EQ(columns_of({400, 500}, 6), 3);
}

TEST(ViewGrid, WideViewsGetWideColumns) {
  const ViewGrid grid =
      arrange_views({{{300, 100}}, {{100, 100}}}, {{0, 0}, {200, 60}}, kSpacing, std::nullopt);
  EXPECT_NEAR(grid.boxes[0].size.x / grid.boxes[1].size.x, 3, 0.01);
  EXPECT_EQ(grid.boxes[0].size.y, grid.boxes[1].size.y);
}

TEST(ViewGrid, AViewCanHaveItsOwnScale) {
  const ViewGrid grid =
      arrange_views({{{1000, 1000}}, {{1000, 1000}, {}, 50.0}}, kArea, kSpacing, std::nullopt);
  EXPECT_EQ(grid.scale, 10);  // the other view needs only 25 mm
  // a view that is too large does not make the others small
  const ViewGrid large =
      arrange_views({{{1000, 1000}}, {{1000, 1000}, {}, 0.5}}, kArea, kSpacing, std::nullopt);
  EXPECT_EQ(large.scale, 10);
  EXPECT_GE(large.boxes[0].size.x, 100);
  EXPECT_GE(large.boxes[0].size.y, 100);
  expect_apart_and_inside(large, kArea, kSpacing);
  const ViewGrid fixed = arrange_views({{{1000, 1000}}, {{1000, 1000}}}, kArea, kSpacing, 2.0);
  EXPECT_EQ(fixed.scale, 2);
  EXPECT_GT(fixed.tightness, 1);
  expect_apart_and_inside(fixed, kArea, kSpacing);
}

TEST(ViewGrid, BordersAreMillimetersOnPaper) {
  const ViewGrid grid =
      arrange_views({{{100, 100}, {14, 7}}, {{100, 100}, {14, 7}}}, kArea, kSpacing, std::nullopt);
  for (const Box& box : grid.boxes) {
    EXPECT_GE(box.size.x, 100 / grid.scale + 28);
    EXPECT_GE(box.size.y, 100 / grid.scale + 14);
  }
}

TEST(ViewGrid, ExtremeViewsHavePlaces) {
  for (const double length : {0.0, 1e-6, 1e9})
    for (const std::size_t count : {2u, 6u}) {
      const ViewGrid grid =
          arrange_views(std::vector<ViewSize>(count, ViewSize{{length, 0}, {}, {}}),
                        {{0, 0}, {30, 20}}, kSpacing, std::nullopt);
      ASSERT_EQ(grid.boxes.size(), count);
      for (const Box& box : grid.boxes) EXPECT_TRUE(box.size.x > 0 && box.size.y > 0);
    }
}

TEST(SheetOfViews, PlacesAreWholePixelsOfTheDrawing) {
  for (const Paper paper : {Paper::a5, Paper::a3})
    for (const int dpi : {50, 97, 600}) {
      const SheetLayout layout(paper_mm(paper, true), {}, {}, dpi);
      const auto arranged = layout.arrange({{{80, 60}}, {{30, 60}}, {{80, 20}}}, std::nullopt);
      for (const ViewPlace& place : arranged.places) {
        const double pixel_mm = 25.4 / dpi;
        EXPECT_NEAR(place.box.size.x, place.width * pixel_mm, 1e-9);
        EXPECT_NEAR(place.box.size.y, place.height * pixel_mm, 1e-9);
        EXPECT_NEAR(place.box.corner.x, layout.drawing().corner.x + place.x * pixel_mm, 1e-9);
        EXPECT_NEAR(place.box.corner.y, layout.drawing().corner.y + place.y * pixel_mm, 1e-9);
        EXPECT_LE(place.x + place.width, layout.drawing_width());
        EXPECT_LE(place.y + place.height, layout.drawing_height());
      }
    }
}

std::vector<std::string> ids_of(const Sheet& sheet) {
  std::vector<std::string> ids;
  for (const Group& group : sheet.groups)
    if (!group.items.empty()) ids.push_back(group.id);
  return ids;
}

TEST(SheetOfViews, OneScaleBarIsForAllViewsWithTheSameScale) {
  const SheetLayout layout(paper_mm(Paper::a4, false), {}, {}, 300);
  for (const bool has_own : {false, true}) {
    std::vector<ViewSize> sizes{{{80, 60}}, {{30, 60}}};
    if (has_own) sizes[1].scale = 7;
    const auto arranged = layout.arrange(sizes, std::nullopt);
    const Sheet sheet = layout.finish({{arranged.places[0], "Front", glm::dvec2(0, -1)},
                                       {arranged.places[1], std::string(300, 'm')}});
    const auto ids = ids_of(sheet);
    EXPECT_EQ(std::ranges::count(ids, "scale-bar"), has_own ? 0 : 1);
    EXPECT_EQ(std::ranges::count(ids, "scale-bar-2"), has_own ? 1 : 0);
    EXPECT_EQ(std::ranges::count(ids, "north-1"), 1);
    EXPECT_EQ(std::ranges::count(ids, "north"), 0);
  }
}

}  // namespace
}  // namespace strata::figure
