// The depth of lines: drawn grooves, derivatives of Gaussians by brute force, and polynomials on
// surfaces with seams.
#include "query/regions/line_depth.h"

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

constexpr double kPi = std::numbers::pi;
using ValueAt = std::function<std::optional<double>(glm::dvec3)>;

glm::dvec3 place(const Surface& surface, std::uint32_t texel) {
  return surface.geometry.origin + glm::dvec3(surface.map.position(texel / 64, int(texel % 64)));
}
SurfaceValues put(const Surface& surface, const ValueAt& value_at) {
  const std::size_t slots = surface.map.block_of_slot.size();
  SurfaceValues values{std::vector<std::uint32_t>(slots * 64), std::vector<std::uint64_t>(slots)};
  test::for_each_surface_texel(surface.map, [&](std::uint32_t texel) {
    if (const auto value = value_at(place(surface, texel)))
      values.set(texel, {std::bit_cast<std::uint32_t>(static_cast<float>(*value)), true});
  });
  return values;
}
std::optional<double> number_at(const SurfaceValues& values, std::uint32_t texel) {
  const TexelValue value = values.of(texel);
  if (!value.valid) return std::nullopt;
  return double{std::bit_cast<float>(value.bits)};
}
Result<SurfaceValues> compute(const Surface& surface, const SurfaceValues& values, double width,
                              Line line = Line::valley, int threads = 2) {
  Progress progress;
  return line_depth_values(line, values, ValueType::f32, width, surface.map, surface.graph, "e",
                           progress, threads);
}

// A groove along a line through the middle of the sheet, whose normal has this angle. Texels at its
// sides are covered in part.
struct Groove {
  double angle, width, depth;
  double from_center(glm::dvec2 at) const {
    return std::abs((at.x - 0.5 * kSheetWidth) * std::cos(angle) +
                    (at.y - 0.5 * kSheetHeight) * std::sin(angle));
  }
  double operator()(glm::dvec2 at) const {
    return 100 - depth * std::clamp(width / 2 + 0.5 - from_center(at), 0.0, 1.0);
  }
};

TEST(LineDepth, is_the_depth_of_grooves_at_all_angles) {
  const Surface sheet = test::cut_sheet();
  // For a width of 6: the depth of grooves of 3 and 6 is exact, and that of others is known.
  for (const auto& [width, right] : {std::pair(1.5, 0.73), std::pair(3.0, 1.0), std::pair(4.5, 1.0),
                                     std::pair(6.0, 1.0), std::pair(12.0, 0.45)})
    for (int i = 0; i < 9; ++i) {
      const Groove groove{i * kPi / 9 + 0.05, width, 2};
      const auto values =
          put(sheet, [&](glm::dvec3 at) { return std::optional(groove(glm::dvec2(at))); });
      const auto depth = compute(sheet, values, 6);
      ASSERT_TRUE(depth);
      int on_line = 0;
      test::for_each_surface_texel(sheet.map, [&](std::uint32_t texel) {
        const glm::dvec2 at(place(sheet, texel));
        if (std::min({at.x, at.y, kSheetWidth - at.x, kSheetHeight - at.y}) < 9) return;
        const double found = *number_at(*depth, texel), away = groove.from_center(at);
        if (away < 0.3) {
          ASSERT_NEAR(found, groove.depth * right, 0.1 * groove.depth) << width << ' ' << i;
          ++on_line;
        }
        if (away > width / 2 + 10) {
          ASSERT_NEAR(found, 0, 0.02) << width << ' ' << i;
        }
      });
      EXPECT_GT(on_line, 20);
    }
}

// The same with sums over a grid: derivatives of Gaussians, whose σ is the half of the width or
// smaller.
double by_brute_force(const std::vector<std::vector<double>>& grid, glm::ivec2 at, double width) {
  double strongest = 0;
  for (const double sigma : {width / 2, width / std::sqrt(8.0), width / 4}) {
    double uu = 0, uv = 0, vv = 0;
    for (int y = -25; y <= 25; ++y)
      for (int x = -25; x <= 25; ++x) {
        const double value = grid[std::size_t(at.y + y)][std::size_t(at.x + x)], u = x / sigma,
                     v = y / sigma,
                     weight = std::exp(-(u * u + v * v) / 2) / (2 * kPi * sigma * sigma);
        uu += weight * (u * u - 1) * value;
        uv += weight * u * v * value;
        vv += weight * (v * v - 1) * value;
      }
    strongest = std::max(strongest, (uu + vv) / 2 + std::hypot((uu - vv) / 2, uv));
  }
  return strongest / (2 / std::sqrt(2 * kPi * std::numbers::e));
}

TEST(LineDepth, equals_derivatives_of_gaussians_with_and_without_seams) {
  std::vector<std::vector<double>> grid(kSheetHeight, std::vector<double>(kSheetWidth));
  std::mt19937 random(7);
  std::normal_distribution<double> noise(5, 1);
  for (auto& row : grid)
    for (double& value : row) value = noise(random);
  for (const SheetCuts& cuts :
       {SheetCuts{}, SheetCuts{{96}, {64}}, SheetCuts{{40, 96, 104, 152}, {24, 64}}}) {
    const Surface sheet = test::cut_sheet(cuts);
    const auto values = put(sheet, [&](glm::dvec3 at) {
      return std::optional(grid[std::size_t(at.y)][std::size_t(at.x)]);
    });
    const auto depth = compute(sheet, values, 8);
    ASSERT_TRUE(depth);
    double off = 0, squares = 0;
    test::for_each_surface_texel(sheet.map, [&](std::uint32_t texel) {
      const glm::ivec2 at = test::sheet_place(sheet, texel);
      if (at.x % 3 != 0 || at.y % 3 != 0 || at.x < 25 || at.y < 25 || at.x >= kSheetWidth - 25 ||
          at.y >= kSheetHeight - 25)
        return;
      const double right = by_brute_force(grid, at, 8);
      off += std::pow(*number_at(*depth, texel) - right, 2);
      squares += right * right;
    });
    EXPECT_LT(std::sqrt(off / squares), 0.05);
  }
}

// A tube whose values are a polynomial of the unrolled coordinates, and a plane.
test::Shape tube() {
  return {64, 64,
          [](double s, double t) { return glm::dvec3(std::cos(5 * s), std::sin(5 * s), 4 * t); },
          [](double s, double t) { return glm::dvec2(5 * s, 4 * t); }};
}
glm::dvec2 on_tube(glm::dvec3 at) {
  const double angle = std::atan2(at.y, at.x);
  return {angle < 0 ? angle + 2 * kPi : angle, at.z};
}

TEST(LineDepth, of_a_polynomial_is_its_largest_second_derivative_on_any_atlas) {
  // The Hessian has the eigenvalues 3 and -1.
  const auto polynomial = [](glm::dvec2 p) {
    const double along = p.x * std::cos(0.6) + p.y * std::sin(0.6),
                 across = p.y * std::cos(0.6) - p.x * std::sin(0.6);
    return 1.5 * along * along - 0.5 * across * across + 2 * p.x - p.y;
  };
  for (const test::Cuts cuts :
       {test::Cuts{1, 1, 0, 1}, test::Cuts{3, 4}, test::Cuts{2, 2, 1, 0.5}}) {
    const Surface surface = test::cut_surface(tube(), cuts, 512);
    const double width = 8 * mean_texel_size(surface.map), sigma = width / 2;
    const auto values =
        put(surface, [&](glm::dvec3 at) { return std::optional(polynomial(on_tube(at))); });
    const auto depth = compute(surface, values, width);
    ASSERT_TRUE(depth);
    const double right = 3 * sigma * sigma / 0.48394;
    std::vector<double> found;
    test::for_each_surface_texel(surface.map, [&](std::uint32_t texel) {
      const glm::dvec2 at = on_tube(place(surface, texel));
      if (at.x < width || at.y < width || at.x > 5 - width || at.y > 4 - width) return;
      found.push_back(*number_at(*depth, texel));
      ASSERT_NEAR(found.back(), right, 0.1 * right) << at.x << ' ' << at.y;
    });
    double sum = 0;
    for (const double each : found) sum += each;
    EXPECT_NEAR(sum / double(found.size()), right, 0.02 * right);
  }
}

TEST(LineDepth, of_ridges_is_that_of_valleys_of_the_opposite_values) {
  const Surface sheet = test::cut_sheet({{96}, {}});
  const Groove groove{0.4, 5, 2};
  const auto values =
      put(sheet, [&](glm::dvec3 at) { return std::optional(groove(glm::dvec2(at))); });
  const auto opposite =
      put(sheet, [&](glm::dvec3 at) { return std::optional(-groove(glm::dvec2(at))); });
  EXPECT_EQ(compute(sheet, values, 6)->bits, compute(sheet, opposite, 6, Line::ridge)->bits);
  const auto ridges = compute(sheet, values, 6, Line::ridge);
  test::for_each_surface_texel(sheet.map, [&](std::uint32_t texel) {
    const glm::dvec2 at(place(sheet, texel));
    if (groove.from_center(at) < 1) {
      ASSERT_LT(*number_at(*ridges, texel), 0.5);
    }
  });
}

TEST(LineDepth, has_a_value_where_the_layer_has_values_around) {
  const Surface sheet = test::cut_sheet();
  const float infinity = std::numeric_limits<float>::infinity();
  const auto values = put(sheet, [&](glm::dvec3 at) -> std::optional<double> {
    if (at.x < 60) return 3 * at.x;                                   // a slope has no lines
    if (at.x < 62 && at.y < 100) return infinity;                     // not a number to compare
    if (at.x > 100 && at.x < 101) return 5;                           // a strip of one texel
    if (std::floor(at.x) == 150 && std::floor(at.y) == 50) return 5;  // a single texel
    return std::nullopt;
  });
  const auto depth = compute(sheet, values, 5);
  ASSERT_TRUE(depth);
  int found = 0;
  test::for_each_surface_texel(sheet.map, [&](std::uint32_t texel) {
    const glm::dvec3 at = place(sheet, texel);
    const auto value = number_at(*depth, texel);
    ASSERT_EQ(value.has_value(), at.x < 60) << at.x << ' ' << at.y;
    if (value) {
      ASSERT_NEAR(*value, 0, 1e-3);
    }
    found += value.has_value();
  });
  EXPECT_EQ(found, 60 * kSheetHeight);
}

TEST(LineDepth, does_not_depend_on_threads_and_can_be_cancelled) {
  const Surface sheet = test::cut_sheet({{96}, {64}});
  const Groove groove{0.4, 5, 2};
  const auto values =
      put(sheet, [&](glm::dvec3 at) { return std::optional(groove(glm::dvec2(at))); });
  EXPECT_EQ(compute(sheet, values, 6, Line::valley, 1)->bits,
            compute(sheet, values, 6, Line::valley, 4)->bits);
  Progress progress;
  progress.cancel();
  EXPECT_EQ(line_depth_values(Line::valley, values, ValueType::f32, 6, sheet.map, sheet.graph, "e",
                              progress)
                .error()
                .code,
            ErrorCode::cancelled);
}

TEST(LineDepth, refuses_a_width_of_less_than_2_or_more_than_22_texels) {
  const Surface sheet = test::cut_sheet();
  const auto values = put(sheet, [](glm::dvec3) { return std::optional(1.0); });
  EXPECT_TRUE(compute(sheet, values, 2.01));
  for (const double width : {0.0, 1.9, 22.1, 1e300, std::numeric_limits<double>::quiet_NaN()}) {
    const auto refused = compute(sheet, values, width);
    ASSERT_FALSE(refused) << width;
    EXPECT_EQ(refused.error().field, "e");
    EXPECT_THAT(refused.error().detail, testing::HasSubstr("2 to 22 texels"));
  }
}

}  // namespace
}  // namespace strata::query
