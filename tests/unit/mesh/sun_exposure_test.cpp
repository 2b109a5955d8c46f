// The path of the sun, and sunlight on planes, a wall, a box and a cone, compared with formulas and
// with sums over single minutes.
#include "mesh/analysis/sun_sectors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "core/progress.h"
#include "support/solids.h"

namespace strata::mesh {
namespace {

constexpr int kEquinox = 79, kJune = 171, kDecember = 354;  // 21 March, 21 June, 21 December

struct Minute {
  glm::dvec3 sun;  // east, north, up
  double energy;   // on a plane that faces the sun, in kWh/m²
};

// The sun in every minute with the sun above the horizon.
std::vector<Minute> minutes(double latitude, int first, int days) {
  std::vector<Minute> result;
  const double phi = latitude * std::numbers::pi / 180;
  for (int day = first; day < first + days; ++day) {
    const double b = 2 * std::numbers::pi * (day % 365) / 365;
    const double delta = 0.006918 - 0.399912 * std::cos(b) + 0.070257 * std::sin(b) -
                         0.006758 * std::cos(2 * b) + 0.000907 * std::sin(2 * b) -
                         0.002697 * std::cos(3 * b) + 0.00148 * std::sin(3 * b);
    const double e0 = 1.00011 + 0.034221 * std::cos(b) + 0.00128 * std::sin(b) +
                      0.000719 * std::cos(2 * b) + 0.000077 * std::sin(2 * b);
    for (int minute = 0; minute < 1440; ++minute) {
      const double h = 2 * std::numbers::pi * (minute + 0.5) / 1440;
      const double up =
          std::sin(phi) * std::sin(delta) + std::cos(phi) * std::cos(delta) * std::cos(h);
      if (up <= 0) continue;
      const double degrees = std::asin(up) * 180 / std::numbers::pi;
      const double mass = 1 / (up + 0.50572 * std::pow(degrees + 6.07995, -1.6364));
      result.push_back(
          {{-std::cos(delta) * std::sin(h),
            std::cos(phi) * std::sin(delta) - std::sin(phi) * std::cos(delta) * std::cos(h), up},
           1.361 * e0 * std::pow(0.7, std::pow(mass, 0.678)) / 60});
    }
  }
  return result;
}

// Adds up the minutes in which the sun is in front of the surface and not hidden.
SkyExposure::Sum by_minutes(
    const std::vector<Minute>& sun, const glm::dvec3& normal,
    const std::function<bool(const glm::dvec3&)>& is_hidden = [](const auto&) { return false; }) {
  SkyExposure::Sum sum;
  for (const Minute& minute : sun) {
    const double cosine = glm::dot(minute.sun, normal);
    if (cosine <= 0 || is_hidden(minute.sun)) continue;
    sum.hours += 1 / 60.0;
    sum.amount += minute.energy * cosine;
  }
  return sum;
}

double hours_of(const std::vector<SkySector>& sectors) {
  double hours = 0;
  for (const SkySector& sector : sectors) hours += sector.hours;
  return hours;
}

std::unique_ptr<SkyExposure> exposure(const TriangleMesh& mesh, double latitude, SunPeriod period) {
  Progress progress;
  auto geometry = std::make_shared<const Geometry>(test::geometry_of(mesh));
  auto made = SkyExposure::make(geometry, sun_sectors(latitude, period), progress);
  EXPECT_TRUE(made);
  return std::move(*made);
}

TEST(SunSectors, have_the_length_of_the_day) {
  EXPECT_NEAR(hours_of(sun_sectors(0, {kEquinox, 1})), 12, 0.1);
  EXPECT_NEAR(hours_of(sun_sectors(50, {kEquinox, 1})), 12, 0.1);
  const double tangents = std::tan(glm::radians(50.0)) * std::tan(glm::radians(23.45));
  EXPECT_NEAR(hours_of(sun_sectors(50, {kJune, 1})), 24 / std::numbers::pi * std::acos(-tangents),
              0.1);
  EXPECT_NEAR(hours_of(sun_sectors(-50, {kJune, 1})), 24 / std::numbers::pi * std::acos(tangents),
              0.1);
  EXPECT_NEAR(hours_of(sun_sectors(80, {kJune, 1})), 24, 1e-9);
  EXPECT_TRUE(sun_sectors(80, {kDecember, 1}).empty());
  EXPECT_NEAR(hours_of(sun_sectors(50, {})), 4380, 30);
}

TEST(SunSectors, continue_into_the_next_year) {
  const double both = hours_of(sun_sectors(50, {360, 10}));
  EXPECT_NEAR(both, hours_of(sun_sectors(50, {360, 5})) + hours_of(sun_sectors(50, {0, 5})), 1e-9);
  EXPECT_LT(both, 85);
}

TEST(SunSectors, are_highest_at_noon_in_the_south_or_north) {
  for (const double latitude : {50.0, -50.0}) {
    const auto sectors = sun_sectors(latitude, {kEquinox, 1});
    const auto noon = *std::ranges::max_element(
        sectors, {}, [](const SkySector& sector) { return sector.direction.z; });
    EXPECT_NEAR(glm::degrees(std::asin(noon.direction.z)), 40, 2);
    EXPECT_NEAR(noon.direction.x, 0, 0.1);
    EXPECT_EQ(noon.direction.y<0, latitude> 0);
  }
}

TEST(SunSectors, of_a_year_are_few) { EXPECT_LT(sun_sectors(50, {}).size(), 450u); }

TEST(SunExposure, of_free_planes_is_that_of_all_minutes) {
  for (const double latitude : {0.0, 37.9, -33.0, 65.0})
    for (const SunPeriod period : {SunPeriod{}, SunPeriod{kJune - 15, 30}}) {
      const auto light = exposure(test::nothing_near(), latitude, period);
      const auto sun = minutes(latitude, period.first, period.days);
      const double most = by_minutes(sun, {0, 0, 1}).hours;
      for (const glm::dvec3 facing :
           {glm::dvec3(0, 0, 1), glm::dvec3(0, -1, 0), glm::dvec3(0, 1, 0), glm::dvec3(1, 0, 0),
            glm::dvec3(1, -1, 1), glm::dvec3(-1, 2, 0.5)}) {
        const glm::dvec3 normal = glm::normalize(facing);
        const auto right = by_minutes(sun, normal);
        const auto found = light->at({0, 0, 1000}, glm::vec3(normal));
        EXPECT_NEAR(found.hours, right.hours, 0.03 * most) << latitude << ' ' << facing.y;
        EXPECT_NEAR(found.amount, right.amount, 0.01 * right.amount + 1)
            << latitude << ' ' << facing.x << ' ' << facing.y;
      }
    }
}

TEST(SunExposure, behind_a_wall_is_that_of_all_minutes) {
  // A wall along the east, of height 1, and ground to the north of it.
  TriangleMesh wall;
  wall.positions = {{-500, 0, 0}, {500, 0, 0}, {500, 0, 1}, {-500, 0, 1}};
  wall.triangles = {0, 1, 2, 0, 2, 3};
  const auto geometry = test::geometry_of(wall);
  const auto sun = minutes(48, 0, 365);
  const auto light = exposure(wall, 48, {});
  const auto open = by_minutes(sun, {0, 0, 1});
  for (const double away : {0.3, 1.0, 2.0, 5.0}) {
    const auto right = by_minutes(
        sun, {0, 0, 1}, [&](const glm::dvec3& to) { return to.y < 0 && to.z / -to.y < 1 / away; });
    const auto found = light->at(glm::vec3(glm::dvec3(0, away, 1e-6) - geometry.origin), {0, 0, 1});
    EXPECT_NEAR(found.hours, right.hours, 0.04 * open.hours) << away;
    EXPECT_NEAR(found.amount, right.amount, 0.04 * open.amount) << away;
    EXPECT_LT(found.amount, open.amount) << away;
  }
}

TEST(SunExposure, of_a_box_depends_on_its_sides) {
  const auto light = exposure(test::box({-1, -1, -1}, {1, 1, 1}), 45, {});
  const auto at = [&](glm::vec3 side) { return light->at(side, side); };
  const auto top = at({0, 0, 1}), south = at({0, -1, 0}), north = at({0, 1, 0}),
             east = at({1, 0, 0}), west = at({-1, 0, 0}), bottom = at({0, 0, -1});
  const auto sun = minutes(45, 0, 365);
  EXPECT_NEAR(top.amount, by_minutes(sun, {0, 0, 1}).amount, 0.01 * top.amount);
  EXPECT_NEAR(south.amount, by_minutes(sun, {0, -1, 0}).amount, 0.01 * south.amount);
  EXPECT_NEAR(east.amount, west.amount, 0.01 * east.amount);
  EXPECT_GT(south.amount, east.amount);
  EXPECT_GT(east.amount, 3 * north.amount);
  EXPECT_EQ(bottom.hours, 0);
}

TEST(SunExposure, of_a_cone_is_that_of_its_tangent_planes) {
  constexpr int kSides = 360;
  TriangleMesh cone;
  cone.positions.push_back({0, 0, 2});
  for (int i = 0; i < kSides; ++i) {
    const double angle = 2 * std::numbers::pi * i / kSides;
    cone.positions.push_back({std::cos(angle), std::sin(angle), 0});
  }
  for (std::uint32_t i = 0; i < kSides; ++i) {
    cone.triangles.insert(cone.triangles.end(), {0, 1 + i, 1 + (i + 1) % kSides});
  }
  const auto geometry = test::geometry_of(cone);
  const auto light = exposure(cone, 37.9, {});
  const auto sun = minutes(37.9, 0, 365);
  for (int i = 0; i < kSides; i += 15) {
    const double angle = 2 * std::numbers::pi * (i + 0.5) / kSides;
    const glm::dvec3 normal =
        glm::normalize(glm::dvec3(2 * std::cos(angle), 2 * std::sin(angle), 1));
    const glm::dvec3 place = glm::dvec3(0.5 * std::cos(angle), 0.5 * std::sin(angle), 1) +
                             1e-3 * normal - geometry.origin;
    const auto right = by_minutes(sun, normal);
    const auto found = light->at(glm::vec3(place), glm::vec3(normal));
    EXPECT_NEAR(found.amount, right.amount, 0.015 * right.amount) << i;
  }
}

TEST(SunExposure, needs_a_normal_and_can_be_cancelled) {
  const auto light = exposure(test::nothing_near(), 45, {kJune, 1});
  EXPECT_TRUE(std::isnan(light->at({0, 0, 0}, {0, 0, 0}).hours));
  Progress progress;
  progress.cancel();
  const auto refused =
      SkyExposure::make(std::make_shared<const Geometry>(test::geometry_of(test::ball(100))),
                        sun_sectors(45, {kJune, 1}), progress);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::cancelled);
}

}  // namespace
}  // namespace strata::mesh
