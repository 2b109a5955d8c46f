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
#include <utility>
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

WaterFalls falls_of(const Surface& surface) {
  Progress progress;
  auto falls = WaterFalls::make(std::make_shared<const mesh::Geometry>(surface.geometry),
                                surface.map, surface.graph, kUp, progress);
  EXPECT_TRUE(falls);
  return std::move(*falls);
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
  const WaterFalls falls = falls_of(surface);
  auto result = run_off(rain, ValueType::f32, kUp, texels_where(surface, drips_at), falls,
                        surface.map, surface.graph, progress);
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

// Adds a sheet of squares over two parameters, which faces up if x and y grow with them.
void add_sheet(mesh::TriangleMesh& mesh, const std::function<glm::dvec3(double, double)>& at) {
  constexpr std::uint32_t kCells = 40;
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (std::uint32_t t = 0; t <= kCells; ++t)
    for (std::uint32_t s = 0; s <= kCells; ++s)
      mesh.positions.push_back(at(double(s) / kCells, double(t) / kCells));
  for (std::uint32_t t = 0; t < kCells; ++t)
    for (std::uint32_t s = 0; s < kCells; ++s) {
      const std::uint32_t corner = first + t * (kCells + 1) + s, above = corner + kCells + 1;
      for (const std::uint32_t each : {corner, corner + 1, above + 1, corner, above + 1, above})
        mesh.triangles.push_back(each);
    }
}

// A roof that leans to the right by 10.
void add_roof(mesh::TriangleMesh& mesh, double left, double right, double z, double half_depth) {
  add_sheet(mesh, [=](double s, double t) {
    return glm::dvec3(left + (right - left) * s, half_depth * (2 * t - 1), z - 10 * s);
  });
}

RunOff run_on_first_roof(const Surface& surface) {
  RunOff water =
      run_on(surface, [](glm::dvec3 at) { return at.z > 49 && at.x < 50 ? 1.0f : 0.0f; });
  const double right = 60 * std::hypot(40, 10);
  EXPECT_NEAR(water.fallen, right, 0.01 * right);
  return water;
}

TEST(RunOff, lands_on_each_roof_below_an_edge_and_leaves_from_the_lowest) {
  mesh::TriangleMesh roofs;
  add_roof(roofs, 0, 40, 60, 30);
  add_roof(roofs, 100, 140, 40, 30);  // not under the edge
  const RunOff one = run_on_first_roof(test::surface_of("roof", roofs, kResolution));
  EXPECT_NEAR(one.over_edges, one.fallen, 1e-6 * one.fallen);
  EXPECT_EQ(one.landed, 0);

  add_roof(roofs, 0, 80, 20, 50);
  const Surface surface = test::surface_of("two roofs", roofs, kResolution);
  const RunOff two = run_on_first_roof(surface);
  EXPECT_NEAR(two.over_edges, two.fallen, 1e-6 * two.fallen);
  EXPECT_NEAR(two.landed, two.fallen, 0.001 * two.fallen);
  const double error = error_of(
      surface, two, [](glm::dvec3) { return std::hypot(40, 10); },
      [](glm::dvec3 at) { return at.z < 25 && at.x > 46 && at.x < 78 && std::abs(at.y) < 26; });
  EXPECT_LT(error, 0.1);
  RecordProperty("roof", std::to_string(error));
  test::for_each_surface_texel(surface.map, [&](std::uint32_t texel) {
    const glm::dvec3 at = world(surface, texel);
    if (at.z < 25 && at.x < 38) {
      ASSERT_EQ(std::bit_cast<float>(two.passing.bits[texel]), 0) << at.x;
    }
  });

  add_roof(roofs, 20, 150, -10, 60);
  const RunOff three = run_on_first_roof(test::surface_of("three roofs", roofs, kResolution));
  EXPECT_NEAR(three.over_edges, three.fallen, 1e-6 * three.fallen);
  EXPECT_NEAR(three.landed, 2 * three.fallen, 0.001 * three.fallen);
}

TEST(RunOff, drips_from_an_overhang_onto_the_floor) {
  // A beam with a round top and a flat bottom, above a floor that leans along it.
  mesh::TriangleMesh beam;
  add_sheet(beam, [](double s, double t) {
    const double turn = std::numbers::pi * (1 - s);
    return glm::dvec3(20 * std::cos(turn), 80 * t, 20 * std::sin(turn));
  });
  add_sheet(beam, [](double s, double t) { return glm::dvec3(20 - 40 * s, 80 * t, 0); });
  add_sheet(beam, [](double s, double t) {
    return glm::dvec3(-50 + 100 * s, -10 + 100 * t, -30 - 10 * t);
  });
  const Surface surface = test::surface_of("beam", beam, kResolution);
  const RunOff water = run_on(
      surface, [](glm::dvec3 at) { return at.z > 0.5 ? 1.0f : 0.0f; },
      [](glm::dvec3 at) { return at.z > -1 && at.z < 0.3; });
  EXPECT_NEAR(water.landed, water.fallen, 0.001 * water.fallen);
  EXPECT_NEAR(water.over_edges, water.fallen, 0.001 * water.fallen);
  double sum = 0, aside = 0;
  test::for_each_surface_texel(surface.map, [&](std::uint32_t texel) {
    const glm::dvec3 at = world(surface, texel);
    if (at.z > -20) return;
    const double passing =
        double{std::bit_cast<float>(water.passing.bits[texel])} * double{surface.map.area[texel]};
    sum += passing;
    aside += passing * std::abs(at.x);
  });
  EXPECT_NEAR(aside / sum, 20, 1.5);
}

TEST(RunOff, in_a_cave_without_an_outlet_stays_there) {
  mesh::TriangleMesh cave = test::sphere(32);
  for (std::size_t i = 0; i < cave.triangles.size(); i += 3)
    std::swap(cave.triangles[i], cave.triangles[i + 1]);
  const Surface surface = test::surface_of("cave", cave, 256);
  const auto is_ceiling = [](glm::dvec3 at) { return at.z > 0.5; };
  const RunOff water = run_on(
      surface, [&](glm::dvec3 at) { return is_ceiling(at) ? 1.0f : 0.0f; }, is_ceiling);
  EXPECT_GT(water.landed, 0);
  EXPECT_NEAR(water.pooled, water.fallen, 0.001 * water.fallen);
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

// Is cancelled at a chosen check.
class CancelledAtCheck final : public Progress {
 public:
  explicit CancelledAtCheck(int check) : left_(check) {}
  bool cancelled() const override { return left_-- <= 0; }

 private:
  mutable int left_;
};

TEST(RunOff, can_be_cancelled_at_each_step) {
  const Surface surface = wall(kAtlases[0], 0);
  const WaterFalls falls = falls_of(surface);
  const std::vector<std::uint64_t> none(surface.map.block_of_slot.size(), 0);
  const SurfaceValues dry{std::vector<std::uint32_t>(none.size() * 64), none};
  int checks = 0;
  for (bool ended = false; !ended; ++checks) {
    CancelledAtCheck progress(checks);
    ended = run_off(dry, ValueType::f32, kUp, none, falls, surface.map, surface.graph, progress)
                .has_value();
  }
  EXPECT_GE(checks, 3);  // while it floods, and while the water runs
}

}  // namespace
}  // namespace strata::query
