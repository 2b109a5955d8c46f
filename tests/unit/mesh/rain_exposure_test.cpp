// Driving rain on planes, a box, a wall under a canopy and a ball, compared with formulas and with
// sums over fine steps of the wind's direction.
#include "mesh/analysis/rain_sectors.h"

#include <gtest/gtest.h>

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

constexpr double kDegree = std::numbers::pi / 180;

const RainClimate kWestWinds{{5, 4, 6, 8, 14, 25, 28, 10}, 4.2, 760, 1.4};

RainClimate from_south(double speed, double rain, double per_hour = 1) {
  RainClimate climate{std::vector<double>(16), speed, rain, per_hour};
  climate.wind_shares[8] = 1;
  return climate;
}

std::unique_ptr<SkyExposure> exposure(const TriangleMesh& mesh, const RainClimate& climate) {
  Progress progress;
  auto made = SkyExposure::make(std::make_shared<const Geometry>(test::geometry_of(mesh)),
                                rain_sectors(climate), progress);
  EXPECT_TRUE(made);
  return std::move(*made);
}

// Adds up the rain of steps of 0.05° of the wind's direction, where it is not sheltered. `rain` is
// the vector from a place towards the falling rain, of any length: east, north, up.
double by_steps(
    const RainClimate& climate, const glm::dvec3& normal,
    const std::function<bool(const glm::dvec3&)>& is_sheltered = [](const auto&) {
      return false;
    }) {
  const auto sectors = static_cast<double>(climate.wind_shares.size());
  double shares = 0, sum = 0;
  for (const double share : climate.wind_shares) shares += share;
  for (int step = 0; step < 7200; ++step) {
    const double degrees = (step + 0.5) / 20;
    const double share = climate.wind_shares[static_cast<std::size_t>(
                             std::fmod(degrees / 360 * sectors + 0.5, sectors))] /
                         shares * sectors / 7200;
    const double carried = 2.0 / 9 * climate.wind_speed_m_s *
                           std::pow(climate.rain_mm_per_hour, 8.0 / 9) *
                           (climate.rain_mm / climate.rain_mm_per_hour);
    const glm::dvec3 rain(carried * std::sin(degrees * kDegree),
                          carried * std::cos(degrees * kDegree), climate.rain_mm);
    if (!is_sheltered(rain)) sum += share * std::max(0.0, glm::dot(rain, normal));
  }
  return sum;
}

double on_plane(const RainClimate& climate, const glm::dvec3& normal) {
  return exposure(test::nothing_near(), climate)->at({0, 0, 1000}, glm::vec3(normal)).amount;
}

TEST(RainExposure, of_level_ground_is_the_rain) {
  EXPECT_NEAR(on_plane(kWestWinds, {0, 0, 1}), 760, 0.01);
  EXPECT_NEAR(on_plane(from_south(12, 500), {0, 0, 1}), 500, 0.01);
  EXPECT_EQ(on_plane(kWestWinds, {0, 0, -1}), 0);
}

TEST(RainExposure, of_a_free_wall_is_the_airfield_index) {
  // The mean of the cosine over a sector of 22.5°.
  const double spread = std::sin(11.25 * kDegree) / (11.25 * kDegree);
  EXPECT_NEAR(on_plane(from_south(4.5, 800), {0, -1, 0}), 800 * spread, 0.5);
  EXPECT_NEAR(on_plane(from_south(4.5, 800, 2), {0, -1, 0}),
              2.0 / 9 * 4.5 * std::pow(2, 8.0 / 9) * 400 * spread, 0.5);
  EXPECT_EQ(on_plane(from_south(4.5, 800), {0, 1, 0}), 0);
  EXPECT_NEAR(on_plane(from_south(4.5, 800), {1, 0, 0}),
              800 * (1 - std::cos(11.25 * kDegree)) / (22.5 * kDegree), 0.5);
  EXPECT_NEAR(on_plane(from_south(0, 800), {0, -1, 0}), 0, 1e-4);
}

TEST(RainExposure, of_inclined_planes_is_that_of_all_wind_directions) {
  const RainClimate finer{{9, 1, 0, 2, 3, 3, 2, 1, 8, 12, 16, 11, 13, 7, 6, 6}, 7, 1200, 0.8};
  for (const RainClimate& climate : {kWestWinds, finer})
    for (const glm::dvec3 facing : {glm::dvec3(0, -1, 0), glm::dvec3(-1, 0, 0), glm::dvec3(0, 1, 1),
                                    glm::dvec3(-1, -1, 0.5), glm::dvec3(1, 0.3, -0.4)}) {
      const glm::dvec3 normal = glm::normalize(facing);
      const double right = by_steps(climate, normal);
      EXPECT_NEAR(on_plane(climate, normal), right, 0.005 * right) << facing.x;
    }
}

TEST(RainExposure, of_a_box_depends_on_its_sides) {
  const auto rain = exposure(test::box({-1, -1, -1}, {1, 1, 1}), kWestWinds);
  for (const glm::dvec3 side : {glm::dvec3(0, 0, 1), glm::dvec3(0, 0, -1), glm::dvec3(1, 0, 0),
                                glm::dvec3(-1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, -1, 0)})
    EXPECT_NEAR(rain->at(glm::vec3(side), glm::vec3(side)).amount, by_steps(kWestWinds, side), 1)
        << side.x << ' ' << side.y << ' ' << side.z;
}

TEST(RainExposure, of_a_wall_begins_below_the_rain_shadow_of_its_canopy) {
  // A wall along the east that looks south, of height 4, and a canopy of depth 0.5 at its top.
  constexpr double kTop = 4, kDepth = 0.5;
  TriangleMesh house;
  house.positions = {{-500, 0, 0},    {500, 0, 0},          {500, 0, kTop},
                     {-500, 0, kTop}, {500, -kDepth, kTop}, {-500, -kDepth, kTop}};
  house.triangles = {0, 1, 2, 0, 2, 3, 3, 2, 4, 3, 4, 5};
  const auto geometry = test::geometry_of(house);
  const glm::dvec3 normal(0, -1, 0);
  const auto amount_at = [&](const SkyExposure& rain, double height) {
    return rain.at(glm::vec3(glm::dvec3(0, 0, height) - geometry.origin), glm::vec3(normal)).amount;
  };

  // With wind of 4.5 m/s and 1 mm/h, the rain falls at 45°, so the shadow in the middle of the
  // sector is as high as the canopy is deep. At the borders it is higher by 1 / cos 11.25°.
  const RainClimate south = from_south(4.5, 800);
  const auto straight = exposure(house, south);
  const double open = on_plane(south, normal);
  EXPECT_NEAR(amount_at(*straight, 2), open, 0.01);
  EXPECT_NEAR(amount_at(*straight, kTop - kDepth / std::cos(11.25 * kDegree) - 0.01), open, 0.01);
  EXPECT_NEAR(amount_at(*straight, kTop - kDepth + 0.01), 0, 0.01);

  const auto all_winds = exposure(house, kWestWinds);
  for (const double height : {0.5, 1.5, 2.5, 3.0, 3.3, 3.6, 3.9}) {
    const double right = by_steps(kWestWinds, normal, [&](const glm::dvec3& rain) {
      return height + kDepth * rain.z / -rain.y > kTop;
    });
    EXPECT_NEAR(amount_at(*all_winds, height), right, 0.05 * by_steps(kWestWinds, normal))
        << height;
  }
}

TEST(RainExposure, of_a_ball_is_a_quarter_of_the_rain_that_meets_it) {
  const TriangleMesh ball = test::ball(64);
  const auto geometry = test::geometry_of(ball);
  const auto rain = exposure(ball, kWestWinds);
  double area = 0, sum = 0;
  for (std::size_t i = 0; i < ball.triangles.size(); i += 3) {
    const glm::dvec3 a = ball.positions[ball.triangles[i]],
                     b = ball.positions[ball.triangles[i + 1]],
                     c = ball.positions[ball.triangles[i + 2]];
    const glm::dvec3 twice = glm::cross(b - a, c - a), center = (a + b + c) / 3.0;
    const glm::dvec3 normal = glm::normalize(twice);
    const double amount = rain->at(glm::vec3(center - geometry.origin), glm::vec3(normal)).amount;
    area += glm::length(twice) / 2;
    sum += amount * glm::length(twice) / 2;
    if (i % 999 == 0) {
      EXPECT_NEAR(amount, by_steps(kWestWinds, normal), 2);
    }
  }
  const double carried = 2.0 / 9 * 4.2 * std::pow(1.4, 8.0 / 9) * 760 / 1.4;
  EXPECT_NEAR(sum / area, std::hypot(carried, 760) / 4, 1);
}

TEST(RainSectors, contain_all_hours_and_no_direction_without_wind) {
  double hours = 0;
  for (const SkySector& sector : rain_sectors(kWestWinds)) {
    hours += sector.hours;
    EXPECT_NEAR(glm::length(sector.direction), 1, 1e-12);
  }
  EXPECT_NEAR(hours, 760 / 1.4, 1e-9);
  for (const SkySector& sector : rain_sectors(from_south(3, 100))) {
    EXPECT_LT(sector.direction.y, 0);
    EXPECT_LT(std::abs(sector.direction.x), -sector.direction.y * std::tan(11.25 * kDegree));
  }
}

}  // namespace
}  // namespace strata::mesh
