// The cross sections of scans, with noise, handles, bellies and uneven triangles. The walls have
// formulas, which give the true section.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "mesh/rollout/rollout_sheet.h"
#include "mesh/rollout/smooth_section.h"

namespace strata::mesh {
namespace {

constexpr double kNoise = 0.3;  // standard deviation in mm
constexpr double kTexel = 0.2;  // mm; there are 800 texels around the pillars
constexpr double kWallHeight = 60;

// The distance of a wall from the axis z, at an angle and at a height from 0 to 1.
using Wall = std::function<double(double angle, double t)>;

// Returns the mesh of a wall that is seen from the outside, or from the axis. Its triangles are up
// to three times as wide and as high as others. `noise` moves each vertex across the wall.
Geometry wall_scan(const Wall& wall, double noise, bool is_inside = false, double to = kTurn) {
  constexpr std::uint32_t kColumns = 1440, kRows = 60;
  const std::uint32_t columns = to < kTurn ? kColumns + 1 : kColumns;
  std::mt19937 random(5);
  std::normal_distribution<double> bump(0, noise);
  TriangleMesh mesh;
  for (std::uint32_t y = 0; y <= kRows; ++y)
    for (std::uint32_t x = 0; x < columns; ++x) {
      const double s = double(x) / kColumns, v = double(y) / kRows;
      const double angle = to * (s + 0.08 * std::sin(kTurn * s)),
                   t = v - 0.08 * std::sin(kTurn * v);
      const double distance = wall(angle, t) + (noise > 0 ? bump(random) : 0);
      mesh.positions.emplace_back(distance * std::cos(angle), distance * std::sin(angle),
                                  kWallHeight * (t - 0.5));
    }
  for (std::uint32_t y = 0; y < kRows; ++y)
    for (std::uint32_t x = 0; x < kColumns; ++x) {
      std::uint32_t a = y * columns + x, b = y * columns + (x + 1) % columns;
      if (is_inside) std::swap(a, b);
      for (const std::uint32_t corner : {a, b, b + columns, a, b + columns, a + columns})
        mesh.triangles.push_back(corner);
    }
  Atlas atlas;
  atlas.corner_uvs.assign(mesh.triangles.size(), glm::vec2(0.5f));
  return build_geometry(mesh, atlas);
}

const FitRequest::Axis kUpAxis{{0, 0, 0}, {0, 0, 1}};

Result<FittedSheet> section_fit(const Geometry& geometry,
                                const std::optional<FitRequest::Axis>& axis = kUpAxis) {
  FitRequest request;
  request.shape = DevelopedShape::general_cylinder;
  request.axis = axis;
  return fit_sheet(
      [&] { return std::make_shared<SearchTree>(std::make_shared<Geometry>(geometry)); }, geometry,
      request, {}, "z");
}

double largest_step(const CrossSection& section) {
  const std::vector<double>& radii = section.radii();
  double largest = 0;
  for (std::size_t i = 0; i < radii.size(); ++i)
    largest = std::max(largest, std::abs(radii[(i + 1) % radii.size()] - radii[i]));
  return largest;
}

glm::dvec3 place_on(const Wall& wall, double angle) {
  return wall(angle, 0.5) * glm::dvec3(std::cos(angle), std::sin(angle), 0);
}

double wall_length(const Wall& wall, double to) {
  constexpr int kSteps = 50'000;
  double length = 0;
  for (int i = 0; i < kSteps; ++i)
    length += glm::distance(place_on(wall, to * i / kSteps), place_on(wall, to * (i + 1) / kSteps));
  return length;
}

// The radius of a bellied pot. Its median is at the heights 1/4 and 3/4.
double belly(double t) { return 40 + 14 * std::sin(kTurn / 2 * t); }

// A handle over 30° and 60 % of the height, up to 25 mm away from the wall.
double handle(double angle, double t) {
  const double off = std::abs(std::remainder(angle - 1, kTurn)) / (kTurn / 24);
  return off < 1 && t > 0.2 && t < 0.8 ? 25 * std::sqrt(1 - off * off) : 0;
}

TEST(ScannedSection, a_pot_with_a_handle_has_the_circle_of_its_median_radius) {
  const double radius = belly(0.25);
  for (const double ornament : {0.0, 1.0}) {  // mm
    const Geometry pot = wall_scan(
        [&](double angle, double t) {
          return belly(t) + handle(angle, t) + ornament * std::sin(40 * angle) * std::sin(50 * t);
        },
        kNoise);
    const auto fitted = section_fit(pot);
    ASSERT_TRUE(fitted) << fitted.error().detail;
    const CrossSection& section = *fitted->sheet.surface.section;
    EXPECT_NEAR(section.length(), kTurn * radius, 0.002 * kTurn * radius) << ornament;
    EXPECT_LT(largest_step(section), 0.02) << ornament;
    for (const double each : section.radii()) EXPECT_NEAR(each, radius, kTexel) << ornament;
  }
}

TEST(ScannedSection, an_oval_pot_has_the_section_of_its_median_height) {
  const Wall pot = [](double angle, double t) {
    return belly(t) / belly(0.5) * 1200 / std::hypot(24 * std::cos(angle), 50 * std::sin(angle));
  };
  const auto fitted = section_fit(wall_scan(pot, kNoise));
  ASSERT_TRUE(fitted) << fitted.error().detail;
  const double length = belly(0.25) / belly(0.5) * wall_length(pot, kTurn);
  EXPECT_NEAR(fitted->sheet.surface.section->length(), length, 0.002 * length);
}

// A square pillar whose edges have a radius of 2 mm.
double rounded_square(double angle, double) {
  const double round = 2, center = 18, a = std::abs(std::remainder(angle, kTurn / 4));
  if ((center + round) * std::tan(a) < center) return (center + round) / std::cos(a);
  const double along = center * (std::cos(a) + std::sin(a));
  return along + std::sqrt(along * along - 2 * center * center + round * round);
}

double square_wall(double angle, double) { return 20 / std::cos(std::remainder(angle, kTurn / 4)); }

// A star with eight points, from 22 to 30 mm away from the axis.
double star_wall(double angle, double) {
  const double a = std::abs(std::remainder(angle, kTurn / 8));
  const glm::dvec2 point(30, 0), notch(22 * std::cos(kTurn / 16), 22 * std::sin(kTurn / 16));
  const glm::dvec2 side = notch - point;
  return point.x * side.y / (std::cos(a) * side.y - std::sin(a) * side.x);
}

// A pointed arch with a span of 40 over half a turn: two arcs with the radius 40.
double arch_wall(double angle, double) {
  const double x = 20 * std::abs(std::cos(angle));
  return -x + std::sqrt(x * x + 1200);
}

struct NoisyWall {
  const char* name;
  Wall wall;
  bool is_vault;
};
const NoisyWall kNoisyWalls[] = {{"square", square_wall, false},
                                 {"rounded square", rounded_square, false},
                                 {"star", star_wall, false},
                                 {"vault", arch_wall, true}};

TEST(ScannedSection, corners_of_pillars_and_vaults_stay_sharp) {
  for (const NoisyWall& example : kNoisyWalls)
    for (const double noise : {0.0, kNoise}) {
      const double end = example.is_vault ? kTurn / 2 : kTurn;
      const auto fitted = section_fit(wall_scan(example.wall, noise, example.is_vault, end));
      ASSERT_TRUE(fitted) << fitted.error().detail;
      const RolloutSheet& sheet = fitted->sheet;
      const double length = wall_length(example.wall, end);
      EXPECT_NEAR(sheet.max.x - sheet.min.x, length, 0.005 * length) << example.name << noise;
      // The edges of the wall depend on single vertices.
      for (int i = 10; i <= 710; ++i) {
        const double angle = end * i / 720;
        EXPECT_NEAR(sheet.surface.place_of(place_on(example.wall, angle)).height, 0, kTexel)
            << example.name << noise << " at " << angle;
      }
    }
}

TEST(ScannedSection, a_leaning_pillar_keeps_its_width) {
  // The axis of the user leans by 1° against the pillar.
  const auto fitted =
      section_fit(wall_scan(square_wall, kNoise), FitRequest::Axis{{0, 0, 0}, {0.0175, 0, 1}});
  ASSERT_TRUE(fitted) << fitted.error().detail;
  EXPECT_NEAR(fitted->sheet.surface.section->length(), 160, 0.0075 * 160);
}

TEST(ScannedSection, noise_does_not_make_a_column_wider) {
  const auto fitted = section_fit(wall_scan([](double, double) { return 40; }, kNoise));
  ASSERT_TRUE(fitted) << fitted.error().detail;
  const CrossSection& section = *fitted->sheet.surface.section;
  EXPECT_NEAR(section.length(), kTurn * 40, 5e-4 * kTurn * 40);
  EXPECT_LT(largest_step(section), 0.02);
}

TEST(ScannedSection, walls_without_a_common_section_are_refused) {
  // The section of this column turns along the axis.
  const Geometry twisted = wall_scan(
      [](double angle, double t) { return 30 + 8 * std::cos(2 * angle + 9 * t); }, kNoise);
  // The radius of this funnel grows from 6 to 60 mm.
  const Geometry funnel = wall_scan([](double, double t) { return 6 + 54 * t * t * t; }, kNoise);
  for (const Geometry* geometry : {&twisted, &funnel}) {
    const auto refused = section_fit(*geometry, {});
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().field, "axis");
    EXPECT_THAT(refused.error().detail, testing::HasSubstr("`cylinder` or `cone`"));
    EXPECT_TRUE(section_fit(*geometry));  // with an axis of the user
  }
}

TEST(SmoothSection, precise_values_stay_and_bad_ones_have_no_effect) {
  std::vector<Estimate> estimates(360);
  for (std::size_t i = 0; i < 360; ++i) estimates[i] = {std::sin(kTurn * double(i) / 360), 1e-4};
  estimates[100] = {5, 10};
  const std::vector<double> smoothed = smooth_section(estimates);
  for (std::size_t i = 0; i < 360; ++i)
    EXPECT_NEAR(smoothed[i], std::sin(kTurn * double(i) / 360), 1e-3) << i;
}

TEST(SmoothSection, short_gaps_are_smooth_and_long_gaps_straight) {
  std::vector<Estimate> estimates(360);
  for (std::size_t i = 0; i < 360; ++i) estimates[i] = {std::sin(kTurn * double(i) / 360), 1e-4};
  for (std::size_t i = 40; i < 50; ++i) estimates[i] = {};
  for (std::size_t i = 340; i < 380; ++i) estimates[i % 360] = {};
  const std::vector<double> smoothed = smooth_section(estimates);
  for (std::size_t i = 20; i < 340; ++i)
    EXPECT_NEAR(smoothed[i], std::sin(kTurn * double(i) / 360), 1e-3) << i;
  for (std::size_t i = 339; i <= 380; ++i)
    EXPECT_NEAR(smoothed[i % 360], std::lerp(smoothed[339], smoothed[20], (double(i) - 339) / 41),
                1e-9)
        << i;
}

}  // namespace
}  // namespace strata::mesh
