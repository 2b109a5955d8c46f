// Water that runs down: walls and cones by formula on several atlases, hollows, drips, and the sum
// of the water.
#include "query/regions/run_off.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <numbers>
#include <vector>

#include "core/progress.h"
#include "support/cut_shapes.h"
#include "support/meshes.h"

namespace strata::query {
namespace {

using test::Cuts;
using test::Surface;

constexpr Cuts kAtlases[] = {{1, 1, 0, 1}, {3, 2, 0.7, 0.75}, {5, 4, 0.4, 0.6}};
constexpr int kResolution = 512;
const glm::dvec3 kUp(0, 0, 1);

glm::dvec3 world(const Surface& surface, std::uint32_t texel) {
  return surface.geometry.origin +
         glm::dvec3(surface.map.position(texel / 64, static_cast<int>(texel % 64)));
}

std::vector<std::uint64_t> texels_where(const Surface& surface,
                                        const std::function<bool(glm::dvec3)>& holds) {
  std::vector<std::uint64_t> bits(surface.map.block_of_slot.size(), 0);
  test::for_each_surface_texel(surface.map, [&](std::uint32_t texel) {
    if (holds(world(surface, texel))) bits[texel / 64] |= std::uint64_t{1} << texel % 64;
  });
  return bits;
}

RunOff run_on(
    const Surface& surface, const std::function<float(glm::dvec3)>& rain_at,
    const std::function<bool(glm::dvec3)>& drips_at = [](glm::dvec3) { return false; }) {
  const std::size_t slots = surface.map.block_of_slot.size();
  SurfaceValues rain{std::vector<std::uint32_t>(slots * 64), std::vector<std::uint64_t>(slots)};
  test::for_each_surface_texel(surface.map, [&](std::uint32_t texel) {
    rain.set(texel, {std::bit_cast<std::uint32_t>(rain_at(world(surface, texel))), true});
  });
  Progress progress;
  auto result = run_off(rain, ValueType::f32, kUp, texels_where(surface, drips_at), surface.map,
                        surface.graph, progress);
  EXPECT_TRUE(result);
  EXPECT_NEAR(result->fallen, result->over_edges + result->dripped + result->pooled,
              1e-9 * result->fallen);
  return std::move(*result);
}

// The root mean square of the relative difference to a formula, where `counts`. Behind seams, the
// water of single texels differs, so it compares means over cubes with a side of 4.
double error_of(const Surface& surface, const RunOff& water,
                const std::function<double(glm::dvec3)>& expected,
                const std::function<bool(glm::dvec3)>& counts) {
  struct Mean {
    double area = 0, ratio = 0;
  };
  std::map<std::array<int, 3>, Mean> means;
  test::for_each_surface_texel(surface.map, [&](std::uint32_t texel) {
    const glm::dvec3 at = world(surface, texel);
    if (!counts(at)) return;
    const glm::ivec3 cube(glm::floor(at / 4.0));
    Mean& mean = means[{cube.x, cube.y, cube.z}];
    const double area = double{surface.map.area[texel]};
    mean.area += area;
    mean.ratio += area * double{std::bit_cast<float>(water.passing.bits[texel])} / expected(at);
  });
  double squares = 0, area = 0;
  for (const auto& [cube, mean] : means) {
    squares += mean.area * std::pow(mean.ratio / mean.area - 1, 2);
    area += mean.area;
  }
  EXPECT_GT(means.size(), 100u);
  return std::sqrt(squares / area);
}

// A wall of 100 × 100 that leans back by `lean` radians. Water runs along y and z.
Surface wall(const Cuts& cuts, double lean,
             const std::function<double(double, double)>& dent = {}) {
  const test::Shape shape{64, 64,
                          [=](double s, double t) {
                            const double out = dent ? dent(s, t) : 0;
                            return glm::dvec3(100 * s,
                                              100 * t * std::sin(lean) - out * std::cos(lean),
                                              100 * t * std::cos(lean) + out * std::sin(lean));
                          },
                          [](double s, double t) { return glm::dvec2(100 * s, 100 * t); }};
  return test::cut_surface(shape, cuts, kResolution);
}

TEST(RunOff, grows_with_the_way_down_a_wall) {
  for (const Cuts& cuts : kAtlases)
    for (const double lean : {0.0, 0.5}) {
      const Surface surface = wall(cuts, lean);
      const RunOff water = run_on(surface, [](glm::dvec3) { return 2.0f; });
      EXPECT_NEAR(water.fallen, 2 * 100 * 100, 1);
      EXPECT_NEAR(water.over_edges, water.fallen, 1e-6 * water.fallen);
      const double error = error_of(
          surface, water, [&](glm::dvec3 at) { return 2 * (100 - at.z / std::cos(lean)); },
          [&](glm::dvec3 at) { return at.x > 15 && at.x < 85 && at.z < 90 * std::cos(lean); });
      EXPECT_LT(error, cuts.columns == 1 ? 0.01 : 0.08) << cuts.columns << ' ' << lean;
      RecordProperty("wall_" + std::to_string(cuts.columns), std::to_string(error));
    }
}

TEST(RunOff, of_a_cone_is_half_the_way) {
  constexpr double kRadius = 40, kHeight = 60;
  const double slant = std::hypot(kRadius, kHeight);
  for (const Cuts& cuts : kAtlases) {
    const test::Shape cone{128, 64,
                           [=](double s, double t) {
                             const double turn = 2 * std::numbers::pi * s, r = kRadius * (1 - t);
                             return glm::dvec3(r * std::cos(turn), r * std::sin(turn), kHeight * t);
                           },
                           [=](double s, double t) {
                             // Unrolled, a cone is a sector.
                             const double turn = 2 * std::numbers::pi * s * kRadius / slant,
                                          r = slant * (1 - t);
                             return glm::dvec2(r * std::cos(turn), r * std::sin(turn));
                           }};
    const Surface surface = test::cut_surface(cone, cuts, kResolution);
    const RunOff water = run_on(surface, [](glm::dvec3) { return 1.0f; });
    const double error = error_of(
        surface, water, [&](glm::dvec3 at) { return slant * (1 - at.z / kHeight) / 2; },
        [&](glm::dvec3 at) { return at.z < 0.7 * kHeight && at.z > 0.05 * kHeight; });
    EXPECT_LT(error, 0.09) << cuts.columns;
    RecordProperty("cone_" + std::to_string(cuts.columns), std::to_string(error));
  }
}

TEST(RunOff, fills_hollows_and_runs_over) {
  for (const Cuts& cuts : kAtlases) {
    // Dents deep enough to hold water.
    const Surface surface = wall(cuts, 1.2, [](double s, double t) {
      return 4 * std::sin(9 * std::numbers::pi * s) * std::sin(7 * std::numbers::pi * t);
    });
    const RunOff water = run_on(surface, [](glm::dvec3) { return 1.0f; });
    EXPECT_NEAR(water.over_edges, water.fallen, 1e-6 * water.fallen);
    EXPECT_EQ(water.pooled, 0);
  }
}

TEST(RunOff, drips_where_the_surface_faces_down) {
  // The upper three quarters of a horizontal cylinder, which is open at the bottom.
  const auto angle = [](double s) { return std::numbers::pi * (1.5 * s - 0.25); };
  const test::Shape arch{
      96, 32,
      [=](double s, double t) {
        return glm::dvec3(20 * std::cos(angle(s)), 80 * t, 20 * std::sin(angle(s)));
      },
      [](double s, double t) { return glm::dvec2(20 * 1.5 * std::numbers::pi * s, 80 * t); }};
  for (const Cuts& cuts : kAtlases) {
    const Surface surface = test::cut_surface(arch, cuts, kResolution);
    const auto faces_down = [](glm::dvec3 at) { return at.z < -5; };
    const RunOff water = run_on(
        surface, [](glm::dvec3 at) { return at.z > 0 ? 1.0f : 0.0f; }, faces_down);
    EXPECT_NEAR(water.fallen, 20 * std::numbers::pi * 80, 30);
    // The ends of the arch are open edges, where a little water leaves.
    EXPECT_GT(water.dripped, 0.97 * water.fallen);
    test::for_each_surface_texel(surface.map, [&](std::uint32_t texel) {
      const bool is_below = world(surface, texel).z < -7;
      EXPECT_TRUE(!is_below || std::bit_cast<float>(water.passing.bits[texel]) == 0);
    });
  }
}

// Half a cylinder along y, above and below.
TEST(RunOff, drips_where_the_surface_faces_down_by_more_than_30_degrees) {
  const test::Shape tube{
      180, 8,
      [](double s, double t) {
        const double turn = 2 * std::numbers::pi * s;
        return glm::dvec3(20 * std::cos(turn), 30 * t, 20 * std::sin(turn));
      },
      [](double s, double t) { return glm::dvec2(2 * std::numbers::pi * 20 * s, 30 * t); }};
  const Surface surface = test::cut_surface(tube, {1, 1, 0, 1}, kResolution);
  const auto geometry = std::make_shared<const mesh::Geometry>(surface.geometry);
  for (const glm::dvec3 up : {glm::dvec3(0, 0, 1), glm::dvec3(-1, 0, 0)}) {
    Progress progress;
    const auto drips = dripping_texels(geometry, surface.map, up, progress);
    ASSERT_TRUE(drips);
    // The normals of this tube may face in or out.
    double facing = 0;
    test::for_each_surface_texel(surface.map, [&](std::uint32_t texel) {
      if (((*drips)[texel / 64] >> texel % 64 & 1u) != 0)
        facing += glm::dot(world(surface, texel), up);
    });
    ASSERT_NE(facing, 0);
    const double out = facing < 0 ? 1 : -1;
    test::for_each_surface_texel(surface.map, [&](std::uint32_t texel) {
      const glm::dvec3 at = world(surface, texel);
      const double angle =
          std::asin(std::clamp(out * glm::dot(at, up) / 20, -1.0, 1.0)) * 180 / std::numbers::pi;
      if (std::abs(angle + kDripAngle) < 3) return;  // the facets of the tube
      EXPECT_EQ(((*drips)[texel / 64] >> texel % 64 & 1u) != 0, angle < -kDripAngle) << angle;
    });
  }
}

TEST(RunOff, collects_at_the_lowest_place_of_a_closed_surface) {
  const Surface sphere = test::surface_of("sphere", test::sphere(32), 256);
  const RunOff water = run_on(sphere, [](glm::dvec3 at) { return at.z > 0 ? 1.0f : 0.0f; });
  EXPECT_GT(water.fallen, 0);
  EXPECT_NEAR(water.pooled, water.fallen, 1e-6 * water.fallen);
}

TEST(RunOff, ignores_amounts_that_are_no_rain) {
  const Surface surface = wall(kAtlases[0], 0);
  EXPECT_EQ(run_on(surface,
                   [](glm::dvec3 at) {
                     return at.x > 50 ? -1.0f : std::numeric_limits<float>::quiet_NaN();
                   })
                .fallen,
            0);
}

TEST(RunOff, can_be_cancelled) {
  const Surface surface = wall(kAtlases[0], 0);
  Progress progress;
  progress.cancel();
  const std::vector<std::uint64_t> none(surface.map.block_of_slot.size(), 0);
  const SurfaceValues dry{std::vector<std::uint32_t>(none.size() * 64), none};
  EXPECT_FALSE(run_off(dry, ValueType::f32, kUp, none, surface.map, surface.graph, progress));
}

}  // namespace
}  // namespace strata::query
