// Values from distances along a flat sheet, with and without seams.
#include "query/regions/distance_values.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

#include "core/progress.h"
#include "support/cut_sheet.h"

namespace strata::query {
namespace {

using test::SheetCuts;
using test::Surface;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
const SheetCuts kCuts[] = {{}, {{96}, {}}, {{40, 96, 152}, {24, 64}}};

TexelSelection texels_where(const Surface& sheet, const std::function<bool(glm::ivec2)>& holds) {
  TexelSelection selection(sheet.map.block_of_slot.size(), 0);
  test::for_each_surface_texel(sheet.map, [&](std::uint32_t texel) {
    if (holds(test::sheet_place(sheet, texel)))
      selection[texel / 64] |= std::uint64_t{1} << texel % 64;
  });
  return selection;
}
SurfaceValues put(const Surface& sheet, const std::function<std::uint32_t(glm::ivec2)>& value_at) {
  const std::size_t slots = sheet.map.block_of_slot.size();
  SurfaceValues values{std::vector<std::uint32_t>(slots * 64), std::vector<std::uint64_t>(slots)};
  test::for_each_surface_texel(sheet.map, [&](std::uint32_t texel) {
    const std::uint32_t value = value_at(test::sheet_place(sheet, texel));
    values.set(texel, {value, value != 0});
  });
  return values;
}

TEST(DistanceValues, are_lengths_on_a_sheet_up_to_the_limit) {
  for (const SheetCuts& cuts : kCuts)
    for (const double limit : {kInfinity, 1e300, 45.0}) {
      const Surface sheet = test::cut_sheet(cuts);
      const auto sources =
          texels_where(sheet, [](glm::ivec2 at) { return at == glm::ivec2(60, 40); });
      Progress progress;
      const auto values = distance_values(sources, limit, sheet.map, sheet.graph, progress, 2);
      ASSERT_TRUE(values);
      test::for_each_surface_texel(sheet.map, [&](std::uint32_t texel) {
        const glm::ivec2 at = test::sheet_place(sheet, texel);
        const double right = std::hypot(at.x - 60, at.y - 40),
                     allowed = std::max(0.01 * right, 0.5);
        const TexelValue value = values->of(texel);
        if (std::abs(right - limit) > 1) {
          ASSERT_EQ(value.valid, right < limit) << right;
        }
        if (value.valid) {
          ASSERT_NEAR(std::bit_cast<float>(value.bits), right, allowed) << at.x << ' ' << at.y;
        }
      });
    }
}

TEST(DistanceValues, do_not_exist_on_a_piece_without_a_source) {
  const Surface sheet = test::cut_sheet({});
  Progress progress;
  const TexelSelection none(sheet.map.block_of_slot.size(), 0);
  const auto values = distance_values(none, kInfinity, sheet.map, sheet.graph, progress);
  ASSERT_TRUE(values);
  for (const std::uint64_t valid : values->valid) EXPECT_EQ(valid, 0u);
  EXPECT_FALSE(distance_values(none, -1, sheet.map, sheet.graph, progress));
  progress.cancel();
  const auto all = texels_where(sheet, [](glm::ivec2 at) { return at.x == 3; });
  EXPECT_EQ(distance_values(all, kInfinity, sheet.map, sheet.graph, progress).error().code,
            ErrorCode::cancelled);
}

TEST(NearestValues, are_those_of_the_nearest_region) {
  // Three painted spots, and the regions of the texels that are nearest to them.
  const std::vector<std::pair<glm::ivec2, std::uint32_t>> spots{
      {{30, 30}, 7}, {{150, 40}, 4294967295u}, {{90, 110}, 1u << 24 | 1u}};
  for (const SheetCuts& cuts : kCuts)
    for (const double limit : {kInfinity, 40.0}) {
      const Surface sheet = test::cut_sheet(cuts);
      const auto painted = put(sheet, [&](glm::ivec2 at) {
        for (const auto& [place, key] : spots)
          if (at == place) return key;
        return 0u;
      });
      Progress progress;
      const auto values = nearest_values(painted, limit, sheet.map, sheet.graph, progress, 2);
      ASSERT_TRUE(values);
      int farther = 0;
      test::for_each_surface_texel(sheet.map, [&](std::uint32_t texel) {
        const glm::ivec2 at = test::sheet_place(sheet, texel);
        std::vector<std::pair<double, std::uint32_t>> by_distance;
        for (const auto& [place, key] : spots)
          by_distance.emplace_back(std::hypot(at.x - place.x, at.y - place.y), key);
        std::ranges::sort(by_distance);
        const double nearest = by_distance[0].first;
        const TexelValue value = values->of(texel);
        if (std::abs(nearest - limit) > 1) {
          ASSERT_EQ(value.valid, nearest < limit);
        }
        if (!value.valid || value.bits == by_distance[0].second) return;
        // Near the line between two regions, both are almost equally near.
        ASSERT_EQ(value.bits, by_distance[1].second);
        ASSERT_LT(by_distance[1].first - nearest, 5) << at.x << ' ' << at.y;
        if (by_distance[1].first - nearest > 1.5) ++farther;
      });
      EXPECT_LT(farther, 0.001 * double(sheet.map.surface_texels));
    }
}

}  // namespace
}  // namespace strata::query
