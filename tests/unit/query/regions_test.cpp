// Clean-up of regions: shapes with known areas and lengths, brute force on a grid, and the same
// result with seams.
#include "query/regions/regions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "query/regions/border_line.h"
#include "query/regions/majority.h"
#include "query/regions/region_pieces.h"
#include "query/regions/sieve.h"
#include "query/statistics/perimeter.h"
#include "support/cut_shapes.h"
#include "support/cut_sheet.h"
#include "support/meshes.h"

namespace strata::query {
namespace {

using test::kSheetHeight;
using test::kSheetWidth;
using test::SheetCuts;
using test::Surface;

constexpr double kPi = std::numbers::pi;

// The values of a sheet by column and row. 0: no value.
using Grid = std::vector<std::vector<int>>;
using ValueAt = std::function<int(int, int)>;

Grid grid_of(const ValueAt& value_at) {
  Grid grid(kSheetHeight, std::vector<int>(kSheetWidth));
  for (int y = 0; y < kSheetHeight; ++y)
    for (int x = 0; x < kSheetWidth; ++x) grid[std::size_t(y)][std::size_t(x)] = value_at(x, y);
  return grid;
}
int at(const Grid& grid, int x, int y) { return grid[std::size_t(y)][std::size_t(x)]; }

SurfaceValues put(const Surface& surface, const std::function<int(std::uint32_t)>& value_at) {
  const std::size_t slots = surface.map.block_of_slot.size();
  SurfaceValues values{std::vector<std::uint32_t>(slots * 64), std::vector<std::uint64_t>(slots)};
  test::for_each_surface_texel(surface.map, [&](std::uint32_t texel) {
    const int value = value_at(texel);
    values.set(texel, {static_cast<std::uint32_t>(value), value != 0});
  });
  return values;
}
SurfaceValues put(const Surface& sheet, const Grid& grid) {
  return put(sheet, [&](std::uint32_t texel) {
    const glm::ivec2 place = test::sheet_place(sheet, texel);
    return at(grid, place.x, place.y);
  });
}
Grid grid_of(const Surface& sheet, const SurfaceValues& values) {
  Grid grid(kSheetHeight, std::vector<int>(kSheetWidth, -1));
  test::for_each_surface_texel(sheet.map, [&](std::uint32_t texel) {
    const glm::ivec2 place = test::sheet_place(sheet, texel);
    grid[std::size_t(place.y)][std::size_t(place.x)] = static_cast<int>(values.of(texel).bits);
  });
  return grid;
}
Grid grid_of(const Surface& sheet, const TexelSelection& selection) {
  return grid_of(sheet, put(sheet, [&](std::uint32_t texel) {
                   return static_cast<int>(selection[texel / 64] >> texel % 64 & 1u);
                 }));
}

const std::vector<SheetCuts>& all_cuts() {
  static const std::vector<SheetCuts> cuts{{},
                                           {{96}, {}},
                                           {{}, {64}},
                                           {{24, 96, 104}, {}},
                                           {{96}, {64}},
                                           {{96}, {}, 90},
                                           {{40, 96, 152}, {24, 64}}};
  return cuts;
}
const std::vector<Surface>& sheets() {
  static const std::vector<Surface> sheets = [] {
    std::vector<Surface> made;
    for (const SheetCuts& cuts : all_cuts()) made.push_back(test::cut_sheet(cuts));
    return made;
  }();
  return sheets;
}

using Operation = std::function<SurfaceValues(const Surface&, SurfaceValues)>;
Operation sieve_by(double min_area, SieveTo to = SieveTo::longest_border) {
  return [=](const Surface& surface, SurfaceValues values) {
    Progress progress;
    const auto regions = find_regions(values, surface.map, surface.graph, progress);
    return sieve(std::move(values), *regions, min_area, to, surface.map, surface.graph, progress)
        ->values;
  };
}
Operation fill_up_to(double max_area) {
  return [=](const Surface& surface, SurfaceValues values) {
    Progress progress;
    const auto regions = find_regions(values, surface.map, surface.graph, progress);
    return fill_holes(std::move(values), *regions, max_area, surface.map, surface.graph, progress)
        ->values;
  };
}
Operation majority_in(double radius) {
  return [=](const Surface& surface, SurfaceValues values) {
    Progress progress;
    return *majority(std::move(values), {radius}, surface.map, surface.graph, progress, 2);
  };
}

void expect_on_every_sheet(const ValueAt& before, const Operation& operation,
                           const ValueAt& after) {
  const Grid grid = grid_of(before), expected = grid_of(after);
  for (std::size_t i = 0; i < sheets().size(); ++i) {
    SCOPED_TRACE("cuts " + std::to_string(i));
    const Surface& sheet = sheets()[i];
    EXPECT_EQ(grid_of(sheet, operation(sheet, put(sheet, grid))), expected);
  }
}

bool in_rect(int x, int y, int left, int lower, int width, int height) {
  return x >= left && x < left + width && y >= lower && y < lower + height;
}

TEST(Regions, the_sheet_has_square_texels_and_seams_only_move_them) {
  for (const Surface& sheet : sheets()) {
    EXPECT_EQ(sheet.map.surface_texels, std::uint64_t{kSheetWidth} * kSheetHeight);
    test::for_each_surface_texel(sheet.map,
                                 [&](std::uint32_t texel) { ASSERT_EQ(sheet.map.area[texel], 1); });
  }
}

TEST(Regions, are_connected_across_seams_and_have_true_areas) {
  const Grid grid = grid_of([](int x, int y) {
    if (in_rect(x, y, 80, 30, 40, 50)) return 1;
    if (in_rect(x, y, 10, 10, 20, 3)) return 2;
    return 0;
  });
  for (const Surface& sheet : sheets()) {
    const auto regions = find_regions(put(sheet, grid), sheet.map, sheet.graph, Progress{});
    ASSERT_TRUE(regions);
    std::vector<double> areas;
    for (const Region& region : regions->list) {
      areas.push_back(region.area);
      EXPECT_EQ(region.at_open_edge, !region.value.valid);
      EXPECT_EQ(double(region.texels), region.area);
    }
    std::ranges::sort(areas);
    EXPECT_EQ(areas, (std::vector<double>{60, 2000, kSheetWidth * kSheetHeight - 2060.0}));
  }
}

TEST(Regions, of_too_many_values_are_refused) {
  const Surface& sheet = sheets().front();
  const SurfaceValues squares =
      put(sheet, grid_of([](int x, int y) { return 1 + (x / 16 + y / 16) % 2; }));
  EXPECT_TRUE(find_regions(squares, sheet.map, sheet.graph, Progress{}, 96));
  const auto refused = find_regions(squares, sheet.map, sheet.graph, Progress{}, 95);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::invalid);
  EXPECT_EQ(refused.error().field, "layer");
}

TEST(Sieve, small_regions_get_the_value_around_them_and_large_ones_stay) {
  const auto painted = [](bool with_specks) {
    return [=](int x, int y) {
      if (with_specks && in_rect(x, y, 94, 62, 4, 4)) return 3;    // across the seams
      if (with_specks && in_rect(x, y, 30, 100, 1, 1)) return 2;   // on no value
      if (with_specks && in_rect(x, y, 191, 127, 1, 1)) return 2;  // in the corner
      if (in_rect(x, y, 150, 20, 5, 5)) return 4;                  // large enough
      return in_rect(x, y, 60, 40, 80, 50) ? 1 : 0;
    };
  };
  expect_on_every_sheet(painted(true), sieve_by(25), painted(false));
  // A region of exactly the smallest area stays.
  expect_on_every_sheet(painted(true), sieve_by(1), painted(true));
}

TEST(Sieve, the_longest_common_border_decides_and_not_the_larger_neighbour) {
  // The region touches 1 along 10 texels, and 2 along 30 texels.
  const auto painted = [](int middle) {
    return [=](int x, int y) {
      if (in_rect(x, y, 90, 60, 10, 10)) return middle;
      return y >= 70 ? 1 : 2;
    };
  };
  expect_on_every_sheet(painted(5), sieve_by(200), painted(2));
}

TEST(Sieve, a_slanted_border_has_its_true_length_and_not_that_of_its_steps) {
  // A right triangle with legs of 30. Value 1 has the hypotenuse, 42.4 long, with 60 texel edges.
  // Value 2 has 25 + 25 = 50 of the legs, and value 3 has the rest.
  const auto painted = [](int middle) {
    return [=](int x, int y) {
      const int u = x - 80, v = y - 50;
      if (u >= 0 && v >= 0 && u + v < 30) return middle;
      if (u >= 0 && v >= 0) return 1;
      return u >= 25 || v >= 25 ? 3 : 2;
    };
  };
  expect_on_every_sheet(painted(9), sieve_by(600), painted(2));
}

TEST(Sieve, small_regions_among_small_regions_wait_for_their_neighbours) {
  // Nested squares: the inner ones touch only small regions.
  const auto painted = [](bool nested) {
    return [=](int x, int y) {
      const int distance = std::max(std::abs(x - 96), std::abs(y - 64));
      return nested && distance < 10 ? 2 + distance : 1;
    };
  };
  expect_on_every_sheet(painted(true), sieve_by(400), painted(false));
}

TEST(Sieve, a_piece_of_the_surface_without_a_large_region_stays_as_it_is) {
  const auto painted = [](int x, int) { return x < 96 ? 1 : 2; };
  expect_on_every_sheet(painted, sieve_by(1e9), painted);
}

TEST(Sieve, can_remove_the_values_of_small_regions) {
  const auto painted = [](int middle) {
    return [=](int x, int y) { return in_rect(x, y, 94, 62, 4, 4) ? middle : 1; };
  };
  expect_on_every_sheet(painted(2), sieve_by(17, SieveTo::no_value), painted(0));
  expect_on_every_sheet([](int, int) { return 1; }, sieve_by(1e9, SieveTo::no_value),
                        [](int, int) { return 0; });
}

TEST(Sieve, equal_borders_are_decided_by_area_and_then_by_value) {
  const auto by_area = [](int middle) {
    return [=](int x, int y) {
      if (in_rect(x, y, 95, 60, 2, 8)) return middle;
      if (in_rect(x, y, 0, 0, 10, 10)) return 5;  // a part of the left half
      return x < 96 ? 1 : 2;
    };
  };
  expect_on_every_sheet(by_area(9), sieve_by(17), by_area(2));
  const auto by_value = [](int middle) {
    return [=](int x, int y) {
      if (in_rect(x, y, 95, 60, 2, 8)) return middle;
      return x < 96 ? 2 : 1;
    };
  };
  expect_on_every_sheet(by_value(9), sieve_by(17), by_value(1));
}

TEST(Sieve, no_small_region_remains_and_no_large_one_changes) {
  std::mt19937 random(1);
  const Grid noise = grid_of([&](int, int) { return static_cast<int>(random() % 5 / 2); });
  std::vector<Grid> results;
  for (const Surface& sheet : sheets()) {
    const SurfaceValues before = put(sheet, noise);
    const SurfaceValues after = sieve_by(12)(sheet, before);
    const auto were = find_regions(before, sheet.map, sheet.graph, Progress{});
    test::for_each_surface_texel(sheet.map, [&](std::uint32_t texel) {
      const Region& region = were->list[were->of_texel[texel]];
      if (!region.value.valid || region.area >= 12) {
        ASSERT_EQ(after.of(texel), before.of(texel));
      }
    });
    const auto regions = find_regions(after, sheet.map, sheet.graph, Progress{});
    for (const Region& region : regions->list)
      EXPECT_TRUE(!region.value.valid || region.area >= 12);
    results.push_back(grid_of(sheet, after));
    // Where a seam meets the edge of the mesh, and between charts that are turned, a length may
    // differ by a texel. Regions of a few texels then get another value.
    int different = 0;
    for (int y = 3; y < kSheetHeight - 3; ++y)
      for (int x = 3; x < kSheetWidth - 3; ++x)
        different += at(results.back(), x, y) != at(results.front(), x, y);
    const bool turned = all_cuts()[results.size() - 1].turn != 0;
    EXPECT_LE(different, turned ? 0.01 * kSheetWidth * kSheetHeight : 0);
  }
}

TEST(FillHoles, only_small_holes_within_one_value_are_filled) {
  const auto painted = [](bool filled) {
    return [=](int x, int y) {
      if (in_rect(x, y, 92, 60, 8, 8)) return filled ? 1 : 0;  // across the seams
      if (in_rect(x, y, 70, 50, 9, 9)) return 0;               // too large
      if (in_rect(x, y, 118, 70, 4, 4)) return 0;              // between two values
      if (in_rect(x, y, 0, 60, 3, 3)) return 0;                // at the edge of the mesh
      if (in_rect(x, y, 0, 50, 6, 30)) return 1;
      if (in_rect(x, y, 120, 40, 20, 50)) return 2;
      return in_rect(x, y, 60, 40, 60, 50) ? 1 : 0;
    };
  };
  expect_on_every_sheet(painted(false), fill_up_to(65), painted(true));
}

TEST(FillHoles, counts_the_holes) {
  const Surface& sheet = sheets().front();
  const SurfaceValues values =
      put(sheet, grid_of([](int x, int y) { return x % 10 == 5 && y % 10 == 5 ? 0 : 1; }));
  Progress progress;
  const auto regions = find_regions(values, sheet.map, sheet.graph, progress);
  const auto filled = fill_holes(values, *regions, 2, sheet.map, sheet.graph, progress);
  ASSERT_TRUE(filled);
  EXPECT_EQ(filled->regions, 19u * 13u);
}

// The value with the largest number of texels in a disc, by brute force.
Grid majority_by_brute_force(const Grid& grid, double radius) {
  const int reach = static_cast<int>(radius);
  return grid_of([&](int x, int y) {
    std::map<int, int> counts;
    for (int dy = -reach; dy <= reach; ++dy)
      for (int dx = -reach; dx <= reach; ++dx)
        if (dx * dx + dy * dy <= radius * radius && x + dx >= 0 && x + dx < kSheetWidth &&
            y + dy >= 0 && y + dy < kSheetHeight)
          ++counts[at(grid, x + dx, y + dy)];
    const int own = at(grid, x, y);
    int most = 0;
    for (const auto& [value, count] : counts) most = std::max(most, count);
    if (counts[own] == most) return own;
    for (const auto& [value, count] : counts)
      if (value != 0 && count == most) return value;
    return 0;
  });
}

TEST(Majority, is_that_of_a_disc_of_texels_with_and_without_seams) {
  std::mt19937 random(2);
  const Grid noise = grid_of([&](int, int) { return static_cast<int>(random() % 4); });
  const Grid patches = grid_of([](int x, int y) {
    return static_cast<int>(2.5 + 2.4 * std::sin(x * 0.13 + y * 0.05) * std::cos(y * 0.21));
  });
  for (const double radius : {1.0, 2.5, 5.0, 13.0})
    for (const Grid& grid : {noise, patches}) {
      const Grid expected = majority_by_brute_force(grid, radius);
      EXPECT_NE(expected, grid);
      for (std::size_t i = 0; i < sheets().size(); ++i) {
        SCOPED_TRACE("cuts " + std::to_string(i) + " radius " + std::to_string(radius));
        const Surface& sheet = sheets()[i];
        EXPECT_EQ(grid_of(sheet, majority_in(radius)(sheet, put(sheet, grid))), expected);
      }
    }
}

TEST(Majority, many_values_in_one_neighbourhood_are_all_counted) {
  std::mt19937 random(3);
  const Grid noise = grid_of([&](int, int) { return static_cast<int>(random() % 60); });
  const Grid expected = majority_by_brute_force(noise, 6);
  const Surface& sheet = sheets().front();
  EXPECT_EQ(grid_of(sheet, majority_in(6)(sheet, put(sheet, noise))), expected);
}

TEST(Majority, is_the_same_on_any_number_of_threads) {
  const Surface surface = test::surface_of("torus", test::torus(40), 512);
  std::mt19937 random(4);
  const SurfaceValues values =
      put(surface, [&](std::uint32_t) { return static_cast<int>(random() % 3); });
  Progress progress;
  const auto one = majority(values, {0.03}, surface.map, surface.graph, progress, 1),
             four = majority(values, {0.03}, surface.map, surface.graph, progress, 4);
  ASSERT_TRUE(one && four);
  EXPECT_EQ(one->bits, four->bits);
  EXPECT_EQ(one->valid, four->valid);
}

TEST(Majority, refuses_a_radius_of_too_many_texels) {
  const Surface& sheet = sheets().front();
  Progress progress;
  for (const double radius : {40.1, std::numeric_limits<double>::quiet_NaN()}) {
    // A texel is 1 unit of 0.15 µm.
    const auto refused = majority(put(sheet, grid_of([](int x, int) { return x; })),
                                  {radius, 1.5e-7}, sheet.map, sheet.graph, progress);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::invalid);
    EXPECT_EQ(refused.error().field, "radius_mm");
    EXPECT_NE(refused.error().detail.find("at most 0.00594 mm, which is 40 texels"),
              std::string::npos)
        << refused.error().detail;
  }
}

TEST(Majority, refuses_too_much_work_and_names_the_largest_radius) {
  const Surface& sheet = sheets().front();
  // Stripes of 2 texels: every texel is near a border.
  const SurfaceValues stripes = put(sheet, grid_of([](int x, int) { return 1 + x / 2 % 2; }));
  Progress progress;
  const double texels = kSheetWidth * kSheetHeight;
  const auto run = [&](double radius) {
    return majority(stripes, {radius, 0.001, texels * 25}, sheet.map, sheet.graph, progress);
  };
  EXPECT_TRUE(run(4.99));
  const auto refused = run(5.01);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::invalid);
  EXPECT_EQ(refused.error().field, "radius_mm");
  EXPECT_NE(refused.error().detail.find("at most 5 mm"), std::string::npos)
      << refused.error().detail;
}

TexelSelection line_of(const Surface& surface, const SurfaceValues& values,
                       const BorderLine& line) {
  Progress progress;
  return *select_border_line(values, line, surface.map, surface.graph, progress, 2);
}

TEST(BorderLine, of_a_rectangle_has_its_width_on_both_sides_or_inside) {
  const Grid rect = grid_of([](int x, int y) { return in_rect(x, y, 60, 40, 80, 50) ? 7 : 3; });
  const auto distance_outside = [](int x, int y) {  // to the rectangle, from the outside
    const double dx = std::max({60 - (x + 0.5), x + 0.5 - 140, 0.0}),
                 dy = std::max({40 - (y + 0.5), y + 0.5 - 90, 0.0});
    return std::hypot(dx, dy);
  };
  const auto distance_inside = [](int x, int y) {
    return std::min({x + 0.5 - 60, 140 - (x + 0.5), y + 0.5 - 40, 90 - (y + 0.5)});
  };
  for (const Surface& sheet : sheets()) {
    const SurfaceValues values = put(sheet, rect);
    EXPECT_EQ(grid_of(sheet, line_of(sheet, values, {7, 6, true})), grid_of([&](int x, int y) {
                return in_rect(x, y, 60, 40, 80, 50) && distance_inside(x, y) < 6 ? 1 : 0;
              }));
    // Borders are points between texels, so a rounded corner may differ by a texel.
    const Grid both = grid_of(sheet, line_of(sheet, values, {7, 6, false}));
    for (int y = 0; y < kSheetHeight; ++y)
      for (int x = 0; x < kSheetWidth; ++x) {
        const double distance =
            in_rect(x, y, 60, 40, 80, 50) ? distance_inside(x, y) : distance_outside(x, y);
        if (std::abs(distance - 3) > 0.3) {
          ASSERT_EQ(at(both, x, y) == 1, distance < 3) << x << " " << y;
        }
      }
    // The narrowest line is one texel wide, and runs inside.
    EXPECT_EQ(grid_of(sheet, line_of(sheet, values, {7, 0.01, false})), grid_of([&](int x, int y) {
                return in_rect(x, y, 60, 40, 80, 50) && distance_inside(x, y) < 1 ? 1 : 0;
              }));
  }
}

TEST(BorderLine, is_the_same_with_seams_and_runs_along_the_borders_of_all_values) {
  const Grid patches = grid_of([](int x, int y) {
    return static_cast<int>(2.5 + 2.4 * std::sin(x * 0.13 + y * 0.05) * std::cos(y * 0.21));
  });
  const BorderLine line{{}, 4, false};
  const Grid expected =
      grid_of(sheets().front(), line_of(sheets().front(), put(sheets().front(), patches), line));
  for (const Surface& sheet : sheets()) {
    const Grid found = grid_of(sheet, line_of(sheet, put(sheet, patches), line));
    // At a seam, distances differ by less than a texel.
    int different = 0;
    for (int y = 0; y < kSheetHeight; ++y)
      for (int x = 0; x < kSheetWidth; ++x) different += at(found, x, y) != at(expected, x, y);
    EXPECT_LT(different, 0.002 * kSheetWidth * kSheetHeight);
  }
}

// A slab of 1 × 1 × 0.02 with a border on its front, 0.05 before the rim.
TEST(BorderLine, around_the_rim_of_a_thin_wall_has_its_width_along_the_surface) {
  constexpr double kThickness = 0.02, kWay = 2 + kThickness, kBorder = 0.95;
  test::Shape shape{202, 20, {}, [](double s, double t) { return glm::dvec2(kWay * s, t); }};
  shape.position = [](double s, double t) {
    const double way = kWay * s;  // over the front, the rim and the back
    if (way <= 1) return glm::dvec3(way, t, kThickness);
    if (way <= 1 + kThickness) return glm::dvec3(1, t, 1 + kThickness - way);
    return glm::dvec3(kWay - way, t, 0);
  };
  for (const test::Cuts& cuts : {test::Cuts{1, 1, 0.4, 1}, test::Cuts{4, 3, 0.7, 0.75}}) {
    const Surface slab = test::cut_surface(shape, cuts, 512);
    const auto way = [&](std::uint32_t texel) {
      const glm::dvec3 at = slab.geometry.origin +
                            glm::dvec3(slab.map.position(texel / 64, static_cast<int>(texel % 64)));
      if (at.z > kThickness - 1e-4) return at.x;
      return at.z < 1e-4 ? kWay - at.x : 1 + kThickness - at.z;
    };
    const SurfaceValues values =
        put(slab, [&](std::uint32_t texel) { return way(texel) < kBorder ? 1 : 2; });
    const double texel_size = std::sqrt(slab.map.area_total / double(slab.map.surface_texels));
    for (const double width : {0.06, 0.1, 0.14, 0.2}) {
      SCOPED_TRACE(width);
      const auto line = line_of(slab, values, {{}, width, false});
      EXPECT_NEAR(measure_selection(slab.map, &line).area, width,
                  std::max(0.03 * width, texel_size));
      double farthest = 0;
      test::for_each_surface_texel(slab.map, [&](std::uint32_t texel) {
        if ((line[texel / 64] >> texel % 64 & 1u) != 0)
          farthest = std::max(farthest, std::abs(way(texel) - kBorder));
      });
      EXPECT_NEAR(farthest, width / 2, 2 * texel_size);
    }
  }
}

TEST(BorderLine, around_a_disc_on_a_sphere_has_the_area_of_its_band) {
  const Surface sphere = test::surface_of("sphere", test::sphere(64), 1024);
  const auto cap = put(sphere, [&](std::uint32_t texel) {
    return sphere.map.position(texel / 64, static_cast<int>(texel % 64)).z > 0.5f ? 1 : 0;
  });
  const auto line = line_of(sphere, cap, {1, 0.1, false});
  // The band of a sphere between two heights has the area 2π times their difference.
  const double angle = std::acos(0.5);
  const double expected = 2 * kPi * (std::cos(angle - 0.05) - std::cos(angle + 0.05));
  EXPECT_NEAR(measure_selection(sphere.map, &line).area / expected, 1, 0.02);
}

TEST(Pieces, have_areas_perimeters_and_centers_and_the_largest_comes_first) {
  const Grid grid = grid_of([](int x, int y) {
    if (in_rect(x, y, 80, 50, 40, 30)) return 1;
    if (in_rect(x, y, 10, 10, 60, 30)) return 1;
    if (in_rect(x, y, 100, 100, 3, 3)) return 1;
    return in_rect(x, y, 150, 20, 10, 10) ? 2 : 0;
  });
  for (const Surface& sheet : sheets()) {
    Progress progress;
    const SurfaceValues values = put(sheet, grid);
    const auto pieces = find_pieces(values, {1, 10, 100}, sheet.map, sheet.graph, progress, 2);
    ASSERT_TRUE(pieces);
    ASSERT_EQ(pieces->list.size(), 2u);
    EXPECT_EQ(pieces->list[0].area, 1800);
    EXPECT_EQ(pieces->list[1].area, 1200);
    EXPECT_EQ(pieces->list[1].texels, 1200u);
    EXPECT_NEAR(pieces->list[0].perimeter, 180, 5);
    EXPECT_NEAR(pieces->list[1].perimeter, 140, 5);
    const glm::dvec3 center = pieces->list[1].center + sheet.geometry.origin;
    EXPECT_NEAR(center.x, 100, 0.01);
    EXPECT_NEAR(center.y, 65, 0.01);
    test::for_each_surface_texel(sheet.map, [&](std::uint32_t texel) {
      const glm::ivec2 place = test::sheet_place(sheet, texel);
      const std::uint32_t expected = in_rect(place.x, place.y, 10, 10, 60, 30)   ? 0
                                     : in_rect(place.x, place.y, 80, 50, 40, 30) ? 1
                                                                                 : kNoRegion;
      ASSERT_EQ(pieces->of_texel[texel], expected);
    });
    const auto all = find_pieces(values, {{}, 0, 100}, sheet.map, sheet.graph, progress);
    ASSERT_TRUE(all);
    EXPECT_EQ(all->list.size(), 4u);
    const auto too_many = find_pieces(values, {{}, 0, 3}, sheet.map, sheet.graph, progress);
    ASSERT_FALSE(too_many);
    EXPECT_EQ(too_many.error().code, ErrorCode::invalid);
  }
}

TEST(Pieces, on_a_sphere_have_the_area_and_perimeter_of_a_cap) {
  const Surface sphere = test::surface_of("sphere", test::sphere(64), 1024);
  const auto caps = put(sphere, [&](std::uint32_t texel) {
    const float z = sphere.map.position(texel / 64, static_cast<int>(texel % 64)).z;
    return z > 0.5f ? 1 : z < -0.8f ? 1 : 0;
  });
  Progress progress;
  const auto pieces = find_pieces(caps, {1, 0, 10}, sphere.map, sphere.graph, progress);
  ASSERT_TRUE(pieces);
  ASSERT_EQ(pieces->list.size(), 2u);
  EXPECT_NEAR(pieces->list[0].area / (2 * kPi * 0.5), 1, 0.01);
  EXPECT_NEAR(pieces->list[1].area / (2 * kPi * 0.2), 1, 0.01);
  EXPECT_NEAR(pieces->list[0].perimeter / (2 * kPi * std::sqrt(0.75)), 1, 0.02);
  EXPECT_NEAR(pieces->list[1].perimeter / (2 * kPi * 0.6), 1, 0.02);
}

// On curved surfaces with many seams: a layer with specks and holes becomes the layer without.
TEST(Cleanup, specks_and_holes_on_curved_surfaces_vanish_across_seams) {
  for (const auto& [name, mesh] :
       {test::NamedMesh{"sphere", test::sphere(64)}, test::NamedMesh{"torus", test::torus(40)}}) {
    SCOPED_TRACE(name);
    const Surface surface = test::surface_of(name, mesh, 1024);
    const auto place = [&](std::uint32_t texel) {
      return surface.map.position(texel / 64, static_cast<int>(texel % 64));
    };
    const auto in_speck = [&](std::uint32_t texel) {
      const glm::vec3 cell = glm::fract(place(texel) * 4.0f) - 0.5f;
      return glm::length(cell) < 0.2f;  // of a radius of 0.05
    };
    const auto halves = [&](std::uint32_t texel) { return place(texel).x > 0.013f ? 1 : 2; };
    const double speck = kPi * 0.05 * 0.05;
    const SurfaceValues expected = put(surface, halves);
    const SurfaceValues specks =
        put(surface, [&](std::uint32_t texel) { return in_speck(texel) ? 3 : halves(texel); });
    const SurfaceValues holes =
        put(surface, [&](std::uint32_t texel) { return in_speck(texel) ? 0 : halves(texel); });
    ASSERT_NE(specks.bits, expected.bits);
    std::uint64_t wrong_sieve = 0, wrong_holes = 0, wrong_majority = 0;
    const SurfaceValues sieved = sieve_by(2 * speck)(surface, specks),
                        filled = fill_up_to(2 * speck)(surface, holes),
                        smooth = majority_in(0.08)(surface, specks);
    test::for_each_surface_texel(surface.map, [&](std::uint32_t texel) {
      // A speck at the border of the halves goes to one of them.
      const bool at_border = std::abs(place(texel).x - 0.013f) < 0.11f;
      wrong_sieve += !at_border && sieved.of(texel) != expected.of(texel);
      wrong_holes += !at_border && filled.of(texel) != expected.of(texel);
      wrong_majority += !at_border && smooth.of(texel) != expected.of(texel);
    });
    EXPECT_EQ(wrong_sieve, 0u);
    EXPECT_EQ(wrong_holes, 0u);
    EXPECT_EQ(wrong_majority, 0u);
    // A straight border stays where it is, but for texels next to it.
    const SurfaceValues still = majority_in(0.06)(surface, expected);
    const double texel_size =
        std::sqrt(surface.map.area_total / double(surface.map.surface_texels));
    std::uint64_t moved = 0;
    test::for_each_surface_texel(surface.map, [&](std::uint32_t texel) {
      moved += std::abs(place(texel).x - 0.013f) > 2 * texel_size &&
               still.of(texel) != expected.of(texel);
    });
    EXPECT_EQ(moved, 0u);
  }
}

TEST(Cleanup, a_seam_between_turned_charts_changes_areas_by_less_than_one_percent) {
  const Surface whole = test::cut_sheet(), turned = test::cut_sheet({{96}, {}, 30});
  const auto value_at = [](glm::dvec2 p) {
    if (glm::distance(p, {96, 64}) < 3) return 3;  // a speck and a hole at the seam
    if (glm::distance(p, {96, 30}) < 3) return 0;
    return glm::distance(p, {100, 60}) < 45 ? 1 : p.x > 96 ? 2 : 0;
  };
  const auto areas = [&](const Surface& sheet, const Operation& operation) {
    const SurfaceValues after = operation(
        sheet, put(sheet, [&](std::uint32_t texel) {
          return value_at(glm::dvec2(sheet.geometry.origin) +
                          glm::dvec2(sheet.map.position(texel / 64, static_cast<int>(texel % 64))));
        }));
    std::map<std::uint32_t, double> sums;
    test::for_each_surface_texel(sheet.map, [&](std::uint32_t texel) {
      sums[after.of(texel).bits] += sheet.map.area[texel];
    });
    return sums;
  };
  const Operation line = [](const Surface& sheet, SurfaceValues values) {
    const auto selected = line_of(sheet, values, {1, 8, false});
    return put(sheet, [&](std::uint32_t texel) {
      return static_cast<int>(selected[texel / 64] >> texel % 64 & 1u);
    });
  };
  for (const auto& [name, operation] :
       {std::pair{"sieve", sieve_by(100)}, std::pair{"fill", fill_up_to(100)},
        std::pair{"majority", majority_in(8)}, std::pair{"line", line}}) {
    SCOPED_TRACE(name);
    const auto expected = areas(whole, operation), found = areas(turned, operation);
    ASSERT_EQ(found.size(), expected.size());
    for (const auto& [value, area] : expected)
      EXPECT_NEAR(found.at(value), area, std::max(0.01 * area, 4.0)) << value;  // 4 texels
  }
}

TEST(Cleanup, empty_and_full_layers_and_single_texels_are_handled) {
  const Surface& sheet = sheets().back();
  const auto empty = [](int, int) { return 0; };
  const auto full = [](int, int) { return 4; };
  const auto one = [](int x, int y) { return x == 96 && y == 64 ? 4 : 0; };
  for (const ValueAt& painted : std::vector<ValueAt>{empty, full}) {
    expect_on_every_sheet(painted, sieve_by(100), painted);
    expect_on_every_sheet(painted, fill_up_to(1e9), painted);
    expect_on_every_sheet(painted, majority_in(4), painted);
    const auto line = line_of(sheet, put(sheet, grid_of(painted)), {{}, 4, false});
    EXPECT_EQ(measure_selection(sheet.map, &line).texels, 0u);
  }
  expect_on_every_sheet(one, sieve_by(2), empty);
  expect_on_every_sheet(one, majority_in(2), empty);
  expect_on_every_sheet(one, fill_up_to(1e9), one);
  Progress progress;
  const auto whole =
      find_pieces(put(sheet, grid_of(full)), {4, 0, 1}, sheet.map, sheet.graph, progress);
  ASSERT_TRUE(whole);
  EXPECT_EQ(whole->list.at(0).area, kSheetWidth * kSheetHeight);
  EXPECT_NEAR(whole->list.at(0).perimeter, 2 * (kSheetWidth + kSheetHeight), 32);
}

TEST(Cleanup, a_surface_without_texels_has_no_regions) {
  const mesh::SurfaceMap map;
  const mesh::TexelGraph graph;
  Progress progress;
  const auto regions = find_regions({}, map, graph, progress);
  ASSERT_TRUE(regions);
  EXPECT_TRUE(regions->list.empty());
  EXPECT_TRUE(sieve({}, *regions, 1, SieveTo::longest_border, map, graph, progress));
  EXPECT_TRUE(fill_holes({}, *regions, 1, map, graph, progress));
  EXPECT_TRUE(majority({}, {1}, map, graph, progress));
  EXPECT_TRUE(select_border_line({}, {1, 1, false}, map, graph, progress));
  EXPECT_TRUE(find_pieces({}, {1, 0, 1}, map, graph, progress));
}

// Cancels the work at the check with a chosen number, and counts the checks.
class CancelledAt : public Progress {
 public:
  explicit CancelledAt(int check) : check_(check) {}
  bool cancelled() const override { return ++checks_ > check_; }
  int checks() const { return checks_; }

 private:
  const int check_;
  mutable int checks_ = 0;
};

// Counts the checks of a whole run. Cancelled at any of them, the run must fail.
void expect_every_check_cancels(int least, const std::function<ErrorCode(Progress&)>& run) {
  CancelledAt whole(std::numeric_limits<int>::max());
  ASSERT_EQ(run(whole), ErrorCode{});
  ASSERT_GE(whole.checks(), least);
  const int step = std::max(1, whole.checks() / 50);
  for (int check = 0; check < whole.checks(); check += step) {
    CancelledAt progress(check);
    ASSERT_EQ(run(progress), ErrorCode::cancelled) << "check " << check;
  }
}

TEST(Cleanup, stops_at_every_check_when_cancelled) {
  const Surface& sheet = sheets().back();
  const SurfaceValues values =
      put(sheet, grid_of([](int x, int y) { return (x / 3 + y / 5) % 3; }));
  const auto regions = find_regions(values, sheet.map, sheet.graph, Progress{});
  const auto code = [](const auto& result) { return result ? ErrorCode{} : result.error().code; };
  const mesh::SurfaceMap& map = sheet.map;
  const mesh::TexelGraph& graph = sheet.graph;
  expect_every_check_cancels(
      4, [&](Progress& p) { return code(find_regions(values, map, graph, p)); });
  for (const SieveTo to : {SieveTo::longest_border, SieveTo::no_value})
    expect_every_check_cancels(to == SieveTo::no_value ? 1 : 4, [&](Progress& p) {
      return code(sieve(values, *regions, 100, to, map, graph, p));
    });
  expect_every_check_cancels(
      2, [&](Progress& p) { return code(fill_holes(values, *regions, 100, map, graph, p)); });
  expect_every_check_cancels(
      100, [&](Progress& p) { return code(majority(values, {5}, map, graph, p)); });
  expect_every_check_cancels(5, [&](Progress& p) {
    return code(select_border_line(values, {1, 5, false}, map, graph, p));
  });
  expect_every_check_cancels(6, [&](Progress& p) {
    return code(find_pieces(values, {1, 0, 1000}, map, graph, p));
  });
  expect_every_check_cancels(
      4, [&](Progress& p) { return code(make_patch({}, ValueType::u8, map, values, p)); });
}

TEST(TexelPatch, changes_the_texels_that_differ_and_their_gutter) {
  const Surface sphere = test::surface_of("sphere", test::sphere(32), 512);
  const auto cap = [](float height) {
    return [=](glm::vec3 p) { return p.z > height ? 2 : p.z < -0.7f ? 5 : 0; };
  };
  for (const auto& [from, to] : {std::pair{0.2f, 0.5f}, std::pair{0.5f, 0.2f}}) {
    const TileMap before = test::layer_of(sphere.map, cap(from)),
                  after = test::layer_of(sphere.map, cap(to));
    const TexelPatch patch =
        *make_patch(before, ValueType::u8, sphere.map,
                    read_surface_values(after, ValueType::u8, sphere.map), Progress{});
    EXPECT_NEAR(patch.area, 2 * kPi * 0.3, 0.02);
    TileMap patched = before;
    for (const auto& [address, tile] : patch.tiles) {
      patched[address] = tile.after;
      if (before.contains(address)) {
        EXPECT_EQ(*tile.before, *before.at(address));
      }
      EXPECT_TRUE(tile.texels.any());
    }
    std::erase_if(patched, [](const auto& entry) { return !entry.second->valid.any(); });
    ASSERT_EQ(patched.size(), after.size());
    for (const auto& [address, tile] : after) EXPECT_EQ(*patched.at(address), *tile);
    EXPECT_TRUE(make_patch(before, ValueType::u8, sphere.map,
                           read_surface_values(before, ValueType::u8, sphere.map), Progress{})
                    ->empty());
  }
}

}  // namespace
}  // namespace strata::query
