// Growing and smoothing of selections: brute force on a grid, areas of shapes, and the same with
// seams.
#include "query/regions/dilate_erode.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <functional>
#include <numbers>

#include "core/progress.h"
#include "support/cut_sheet.h"

namespace strata::query {
namespace {

using test::for_each_surface_texel;
using test::kSheetHeight;
using test::kSheetWidth;
using test::sheet_place;
using test::Surface;
using Inside = std::function<bool(int, int)>;  // of a cell, by column and row

// The computed distances are exact but for this many texels, so the result is between two limits.
constexpr double kError = 0.35;

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

TexelSelection select(const Surface& sheet, const Inside& inside) {
  TexelSelection selection(sheet.map.block_of_slot.size(), 0);
  for_each_surface_texel(sheet.map, [&](std::uint32_t texel) {
    const glm::ivec2 place = sheet_place(sheet, texel);
    if (inside(place.x, place.y)) selection[texel / 64] |= std::uint64_t{1} << texel % 64;
  });
  return selection;
}

bool has(const TexelSelection& selection, std::uint32_t texel) {
  return (selection[texel / 64] >> texel % 64 & 1u) != 0;
}

double area_of(const Surface& sheet, const TexelSelection& selection) {
  return measure_selection(sheet.map, &selection).area;
}

TexelSelection grown(const Surface& sheet, const TexelSelection& set, double distance) {
  Progress progress;
  return grow(set, distance, sheet.map, sheet.graph, progress, 2).value();
}

bool patches(int x, int y) {
  return std::sin(x * 0.13 + y * 0.05) * std::cos(y * 0.21) + 0.3 * std::sin(x * 0.9) > 0.4;
}

// Returns whether the center of a cell is within `distance` of the border of the set: half a cell
// is between the border and the centers next to it.
bool reaches(const Inside& inside, int x, int y, double distance) {
  const double radius = distance + 0.5;
  const int reach = static_cast<int>(radius);
  for (int dy = -reach; dy <= reach; ++dy)
    for (int dx = -reach; dx <= reach; ++dx)
      if (dx * dx + dy * dy <= radius * radius && x + dx >= 0 && x + dx < kSheetWidth &&
          y + dy >= 0 && y + dy < kSheetHeight && inside(x + dx, y + dy))
        return true;
  return false;
}

TEST(GrowSelection, adds_and_removes_the_cells_of_brute_force_with_and_without_seams) {
  const Inside outside = [](int x, int y) { return !patches(x, y); };
  for (const double distance : {1.0, 3.3, 6.2})
    for (std::size_t i = 0; i < sheets().size(); ++i) {
      SCOPED_TRACE("sheet " + std::to_string(i) + " distance " + std::to_string(distance));
      const Surface& sheet = sheets()[i];
      const TexelSelection set = select(sheet, patches), more = grown(sheet, set, distance),
                           less = grown(sheet, set, -distance);
      int wrong = 0, changed = 0;
      for_each_surface_texel(sheet.map, [&](std::uint32_t texel) {
        const glm::ivec2 at = sheet_place(sheet, texel);
        const bool before = has(set, texel), after = has(more, texel), rest = has(less, texel);
        EXPECT_TRUE(before <= after && rest <= before);
        wrong += after ? !reaches(patches, at.x, at.y, distance + kError)
                       : reaches(patches, at.x, at.y, distance - kError);
        wrong += rest ? reaches(outside, at.x, at.y, distance - kError)
                      : !reaches(outside, at.x, at.y, distance + kError);
        changed += (after != before) + (rest != before);
      });
      // At seams, the distances of single texels have larger errors.
      EXPECT_LE(wrong, (i == 0 ? 0.01 : 0.04) * changed);
      EXPECT_GT(changed, 100);
    }
}

TEST(GrowSelection, changes_the_area_as_the_formula_of_a_rectangle_says) {
  // A rectangle of 60 × 40 over the seams.
  const auto rectangle = [](int x, int y) { return x >= 66 && x < 126 && y >= 44 && y < 84; };
  for (const Surface& sheet : sheets()) {
    const TexelSelection set = select(sheet, rectangle);
    const double area = area_of(sheet, set), size = std::sqrt(area / (60 * 40));
    for (const double distance : {4.0, 9.5}) {
      const double formula =
          60 * 40 + 2 * (60 + 40) * distance + std::numbers::pi * distance * distance;
      EXPECT_NEAR(area_of(sheet, grown(sheet, set, distance * size)) / area * 60 * 40, formula,
                  0.02 * formula);
      const double rest = (60 - 2 * distance) * (40 - 2 * distance);
      EXPECT_NEAR(area_of(sheet, grown(sheet, set, -distance * size)) / area * 60 * 40, rest,
                  60 + 40);
      // A rectangle has only convex corners, so it is the same after it has grown and shrunk.
      const TexelSelection back =
          grown(sheet, grown(sheet, set, distance * size), -distance * size);
      EXPECT_NEAR(area_of(sheet, back), area, 0.02 * area);
    }
    EXPECT_EQ(grown(sheet, set, 0.1 * size), set);  // less than half a texel
    EXPECT_EQ(area_of(sheet, grown(sheet, set, -30 * size)), 0);
  }
}

TEST(GrowSelection, of_nothing_is_nothing_and_of_everything_is_everything) {
  const Surface& sheet = sheets()[1];
  const TexelSelection all(sheet.map.surface_mask), none(all.size(), 0);
  for (const double distance : {5.0, -5.0}) {
    EXPECT_EQ(grown(sheet, none, distance), none);
    EXPECT_EQ(grown(sheet, all, distance), all);  // the edge of the mesh is no border
  }
}

TEST(SmoothSelection, removes_narrow_pieces_and_closes_narrow_gaps) {
  // A rectangle with a gap of 4 and a strip of 4, and a rectangle with a gap of 20.
  const auto shape = [](int x, int y) {
    const bool block = x >= 20 && x < 90 && y >= 30 && y < 90 && !(x >= 50 && x < 54);
    const bool strip = x >= 90 && x < 110 && y >= 58 && y < 62;
    const bool other = x >= 115 && x < 180 && y >= 30 && y < 90 && !(x >= 140 && x < 160);
    return block || strip || other;
  };
  for (const Surface& sheet : sheets()) {
    Progress progress;
    const auto smoothed =
        smooth(select(sheet, shape), 10, sheet.map, sheet.graph, progress, 2).value();
    for_each_surface_texel(sheet.map, [&](std::uint32_t texel) {
      const glm::ivec2 at = sheet_place(sheet, texel);
      if (at.y < 55 || at.y >= 65) return;
      if (at.x >= 50 && at.x < 54) {
        EXPECT_TRUE(has(smoothed, texel));
      }
      if (at.x >= 98 && at.x < 106) {
        EXPECT_FALSE(has(smoothed, texel));
      }
      if (at.x >= 143 && at.x < 157) {
        EXPECT_FALSE(has(smoothed, texel));
      }
      if (at.x >= 120 && at.x < 135) {
        EXPECT_TRUE(has(smoothed, texel));
      }
    });
  }
}

TEST(GrowSelection, can_be_cancelled) {
  const Surface& sheet = sheets()[0];
  Progress progress;
  progress.cancel();
  EXPECT_EQ(grow(select(sheet, patches), 5, sheet.map, sheet.graph, progress).error().code,
            ErrorCode::cancelled);
}

}  // namespace
}  // namespace strata::query
