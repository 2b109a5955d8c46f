// Basins of a quantity: their number by brute force, their rules, seams, and the stones of a wall.
#include "query/regions/watershed.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <set>
#include <vector>

#include "core/progress.h"
#include "support/cut_sheet.h"

namespace strata::query {
namespace {

using test::SheetCuts;
using test::Surface;

using NumberAt = std::function<float(glm::ivec2)>;

SurfaceValues numbers_on(const Surface& sheet, const NumberAt& number_at) {
  const std::size_t slots = sheet.map.block_of_slot.size();
  SurfaceValues values{std::vector<std::uint32_t>(slots * 64), std::vector<std::uint64_t>(slots)};
  test::for_each_surface_texel(sheet.map, [&](std::uint32_t texel) {
    values.set(texel,
               {std::bit_cast<std::uint32_t>(number_at(test::sheet_place(sheet, texel))), true});
  });
  return values;
}

SurfaceValues basins_of(const Surface& sheet, const SurfaceValues& values, double height) {
  Progress progress;
  auto basins = watershed_values(values, ValueType::f32, height, sheet.map, sheet.graph,
                                 "expression", progress);
  EXPECT_TRUE(basins);
  return std::move(*basins);
}

int basin_at(const SurfaceValues& basins, std::uint32_t texel) {
  return basins.of(texel).valid ? static_cast<int>(std::bit_cast<float>(basins.bits[texel])) : 0;
}

// Smooth hills, whose heights differ everywhere.
NumberAt hills(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> place(-10, 210), size(6, 25), height(-1, 1);
  struct Hill {
    glm::dvec2 at;
    double size, height;
  };
  std::vector<Hill> all;
  for (int i = 0; i < 150; ++i)
    all.push_back({{place(random), place(random)}, size(random), height(random)});
  return [all](glm::ivec2 at) {
    double sum = 0;
    for (const Hill& hill : all) {
      const glm::dvec2 way = (glm::dvec2(at) - hill.at) / hill.size;
      sum += hill.height * std::exp(-glm::dot(way, way));
    }
    return static_cast<float>(sum);
  };
}

// The lowest level at which water from a texel reaches a texel that is lower, less the height of
// the texel: its dynamics, by a flood of its own for each minimum.
std::vector<double> depths_of_minima(const Surface& sheet, const SurfaceValues& values) {
  const auto number = [&](std::uint32_t texel) { return std::bit_cast<float>(values.bits[texel]); };
  std::vector<double> depths;
  test::for_each_surface_texel(sheet.map, [&](std::uint32_t start) {
    bool is_minimum = true;
    mesh::for_each_neighbour(sheet.map, sheet.graph, start, [&](std::uint32_t other) {
      is_minimum &= number(other) > number(start);
    });
    if (!is_minimum) return;
    std::set<std::pair<float, std::uint32_t>> open{{number(start), start}};
    std::set<std::uint32_t> seen{start};
    float level = number(start);
    while (!open.empty()) {
      const auto [height, texel] = *open.begin();
      open.erase(open.begin());
      level = std::max(level, height);
      if (height < number(start)) {
        depths.push_back(double{level} - double{number(start)});
        return;
      }
      mesh::for_each_neighbour(sheet.map, sheet.graph, texel, [&](std::uint32_t other) {
        if (seen.insert(other).second) open.insert({number(other), other});
      });
    }
    depths.push_back(std::numeric_limits<double>::infinity());  // the deepest one
  });
  return depths;
}

const SheetCuts kUncut{}, kSeams{{64, 120}, {40}, 0};

TEST(Watershed, has_a_basin_for_each_minimum_that_is_deep_enough) {
  for (const SheetCuts& cuts : {kUncut, kSeams}) {
    const Surface sheet = test::cut_sheet(cuts);
    const SurfaceValues values = numbers_on(sheet, hills(3));
    const auto depths = depths_of_minima(sheet, values);
    ASSERT_GT(depths.size(), 10u);
    for (const double height : {0.0, 0.02, 0.1, 0.4, 10.0}) {
      const SurfaceValues basins = basins_of(sheet, values, height);
      std::set<int> found;
      test::for_each_surface_texel(
          sheet.map, [&](std::uint32_t texel) { found.insert(basin_at(basins, texel)); });
      const auto expected =
          std::ranges::count_if(depths, [&](double depth) { return depth >= height; });
      EXPECT_EQ(static_cast<long>(found.size()), expected) << height;
      EXPECT_EQ(*found.begin(), 1);
      EXPECT_EQ(*found.rbegin(), expected);
    }
  }
}

// On plateaus, a depth can be exactly the height.
TEST(Watershed, joins_basins_that_are_less_deep_than_the_height) {
  const Surface sheet = test::cut_sheet(kSeams);
  // Three valleys with the floors 0, 2 and 3, and passes of 5 and 4 between them.
  const SurfaceValues steps = numbers_on(sheet, [](glm::ivec2 at) {
    const int column = at.x / 40;
    constexpr float kLevels[] = {0, 5, 2, 4, 3};
    return kLevels[column];
  });
  const auto basins_at = [&](double height) {
    const SurfaceValues basins = basins_of(sheet, steps, height);
    std::map<int, int> of_column;
    test::for_each_surface_texel(sheet.map, [&](std::uint32_t texel) {
      of_column[test::sheet_place(sheet, texel).x / 40] = basin_at(basins, texel);
    });
    return std::array{of_column[0], of_column[2], of_column[4]};
  };
  const auto all = basins_at(1);  // the third valley is exactly 1 deep
  EXPECT_EQ((std::set<int>{all[0], all[1], all[2]}), (std::set<int>{1, 2, 3}));
  const auto joined = basins_at(1.01);
  EXPECT_EQ(joined[1], joined[2]);
  EXPECT_NE(joined[0], joined[1]);
  EXPECT_NE(basins_at(3)[0], basins_at(3)[1]);
  const auto one = basins_at(3.01);
  EXPECT_EQ(one, (std::array{1, 1, 1}));
}

TEST(Watershed, refuses_too_many_basins) {
  const Surface sheet = test::cut_sheet(kUncut);
  const SurfaceValues values = numbers_on(sheet, hills(3));
  Progress progress;
  const auto refused = watershed_values(values, ValueType::f32, 0, sheet.map, sheet.graph,
                                        "expression", progress, 3);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().field, "expression");
  EXPECT_NE(refused.error().detail.find("more than 3 basins"), std::string::npos);
}

TEST(Watershed, has_connected_basins_in_the_order_of_their_areas) {
  const Surface sheet = test::cut_sheet(kSeams);
  const SurfaceValues basins = basins_of(sheet, numbers_on(sheet, hills(4)), 0.05);
  std::map<int, double> areas;
  std::map<int, int> pieces;
  std::set<std::uint32_t> seen;
  test::for_each_surface_texel(sheet.map, [&](std::uint32_t start) {
    areas[basin_at(basins, start)] += double{sheet.map.area[start]};
    if (!seen.insert(start).second) return;
    ++pieces[basin_at(basins, start)];
    std::vector<std::uint32_t> open{start};
    while (!open.empty()) {
      const std::uint32_t texel = open.back();
      open.pop_back();
      mesh::for_each_neighbour(sheet.map, sheet.graph, texel, [&](std::uint32_t other) {
        if (basin_at(basins, other) == basin_at(basins, texel) && seen.insert(other).second)
          open.push_back(other);
      });
    }
  });
  ASSERT_GT(areas.size(), 3u);
  double before = std::numeric_limits<double>::infinity();
  for (const auto& [basin, area] : areas) {
    EXPECT_EQ(pieces[basin], 1) << basin;
    EXPECT_LE(area, before);
    before = area;
  }
}

TEST(Watershed, does_not_change_at_seams) {
  const Surface plain = test::cut_sheet(kUncut), cut = test::cut_sheet(kSeams);
  const SurfaceValues on_plain = basins_of(plain, numbers_on(plain, hills(5)), 0.05),
                      on_cut = basins_of(cut, numbers_on(cut, hills(5)), 0.05);
  std::map<std::pair<int, int>, int> at_place;
  test::for_each_surface_texel(plain.map, [&](std::uint32_t texel) {
    const glm::ivec2 at = test::sheet_place(plain, texel);
    at_place[{at.x, at.y}] = basin_at(on_plain, texel);
  });
  int texels = 0, different = 0;
  test::for_each_surface_texel(cut.map, [&](std::uint32_t texel) {
    const glm::ivec2 at = test::sheet_place(cut, texel);
    ++texels;
    different += at_place.at({at.x, at.y}) != basin_at(on_cut, texel) ? 1 : 0;
  });
  EXPECT_EQ(different, 0) << "of " << texels;
}

TEST(Watershed, leaves_out_texels_without_a_number) {
  const Surface sheet = test::cut_sheet(kUncut);
  // A wall without values divides a plain.
  const SurfaceValues walled = [&] {
    SurfaceValues values = numbers_on(sheet, [](glm::ivec2 at) {
      return at.x == 60 ? std::numeric_limits<float>::quiet_NaN() : 1.0f;
    });
    test::for_each_surface_texel(sheet.map, [&](std::uint32_t texel) {
      if (test::sheet_place(sheet, texel).x == 61) values.set(texel, {});
    });
    return values;
  }();
  const SurfaceValues basins = basins_of(sheet, walled, 0);
  test::for_each_surface_texel(sheet.map, [&](std::uint32_t texel) {
    const int x = test::sheet_place(sheet, texel).x;
    EXPECT_EQ(basin_at(basins, texel), x == 60 || x == 61 ? 0 : x > 61 ? 1 : 2) << x;
  });
}

// A wall of stones in rows, with joints of changing width whose depth is uneven, and rough stones.
struct Wall {
  static constexpr int kRow = 16, kStone = 28;
  static int row_of(double y) { return static_cast<int>(y) / kRow; }
  static double shift(int row) { return 9.0 * (row % 3) + 3.0 * std::sin(row * 2.7); }
  static int stone_of(double x, double y) {
    const int row = row_of(y);
    return row * 100 + static_cast<int>(std::floor((x + shift(row)) / kStone));
  }
  // The distance to the nearest joint.
  static double joint(double x, double y) {
    const int row = row_of(y);
    const double in_row = std::fmod(y, kRow), in_stone = std::fmod(x + shift(row), kStone);
    return std::min({in_row, kRow - in_row, in_stone, kStone - in_stone});
  }
};

TEST(Watershed, finds_the_stones_of_a_wall) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    const Surface sheet = test::cut_sheet(kSeams);
    std::mt19937 random(seed);
    std::normal_distribution<float> rough(0, 0.06f);
    // How much a place looks like a joint: 1 in its middle, with gaps and a rough surface.
    const SurfaceValues jointness = numbers_on(sheet, [&](glm::ivec2 at) {
      const double wave = 0.6 * std::sin(at.x / 7.0) + 0.6 * std::sin(at.y / 9.0 + seed);
      const double distance = Wall::joint(at.x + 0.5 + wave, at.y + 0.5) / 2;
      const double strength = 0.75 + 0.25 * std::sin(at.x / 11.0 + at.y / 5.0 + seed);
      return static_cast<float>(strength * std::exp(-distance * distance)) + rough(random);
    });
    const SurfaceValues basins = basins_of(sheet, jointness, 0.3);
    std::map<int, int> stone_size, basin_size;
    std::map<std::pair<int, int>, int> common;
    test::for_each_surface_texel(sheet.map, [&](std::uint32_t texel) {
      const glm::ivec2 at = test::sheet_place(sheet, texel);
      const int stone = Wall::stone_of(at.x + 0.5, at.y + 0.5), basin = basin_at(basins, texel);
      ++stone_size[stone];
      ++basin_size[basin];
      ++common[{stone, basin}];
    });
    int right = 0, wanted = 0;
    for (const auto& [stone, size] : stone_size) {
      if (size < 100) continue;  // slivers at the edge of the sheet
      ++wanted;
      for (const auto& [pair, both] : common)
        right +=
            pair.first == stone && both > 0.7 * (size + basin_size[pair.second] - both) ? 1 : 0;
    }
    ASSERT_GT(wanted, 40);
    EXPECT_GE(right, 0.8 * wanted) << "of " << wanted << " with seed " << seed;
    RecordProperty("right_of_" + std::to_string(wanted) + "_seed_" + std::to_string(seed), right);
  }
}

// Cancels at a chosen check.
class CancelledAt : public Progress {
 public:
  explicit CancelledAt(int check) : left_(check) {}
  bool cancelled() const override { return left_-- <= 0; }

 private:
  mutable int left_;
};

TEST(Watershed, can_be_cancelled_at_each_step) {
  const Surface sheet = test::cut_sheet(kUncut);
  const SurfaceValues values = numbers_on(sheet, hills(1));
  int checks = 0;
  for (bool ended = false; !ended; ++checks) {
    CancelledAt progress(checks);
    ended =
        watershed_values(values, ValueType::f32, 0, sheet.map, sheet.graph, "expression", progress)
            .has_value();
  }
  EXPECT_GT(checks, 6);
}

}  // namespace
}  // namespace strata::query
