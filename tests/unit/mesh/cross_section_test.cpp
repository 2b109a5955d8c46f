// Rollouts of general cylinders: vaults, pillars and columns whose cross sections have formulas.
#include "mesh/rollout/cross_section.h"

#include <gtest/gtest.h>

#include <cmath>
#include <mutex>
#include <random>

#include "mesh/analysis/tangent_frame.h"
#include "mesh/rollout/trace_rollout.h"
#include "support/cut_shapes.h"

namespace strata::mesh {
namespace {

using test::Cuts;
using test::Shape;
using test::Surface;
constexpr double kLength = 60;  // of the axis
constexpr Cuts kOneChart{1, 1, 0.4, 1}, kManyCharts{3, 4, 0.7, 0.75};
const glm::dvec3 kAlong = glm::normalize(glm::dvec3(0.3, -0.2, 1));
const glm::dvec3 kMiddle(120, -40, 15);

using Curve = std::function<glm::dvec2(double s)>;  // counterclockwise, s from 0 to 1

glm::dvec2 ellipse(double s) { return {30 * std::cos(kTurn * s), 18 * std::sin(kTurn * s)}; }

glm::dvec2 square(double s) {
  const double side = 4 * s, share = 40 * (side - std::floor(side)) - 20;
  switch (static_cast<int>(side) % 4) {
    case 0: return {20, share};
    case 1: return {-share, 20};
    case 2: return {-20, -share};
    default: return {share, -20};
  }
}

// A pointed arch with a span of 40 and a rise of 34.6: two arcs with the radius 40.
glm::dvec2 pointed_arch(double s) {
  const double turn = kTurn / 6;
  return s < 0.5 ? glm::dvec2(-20 + 40 * std::cos(2 * s * turn), 40 * std::sin(2 * s * turn))
                 : glm::dvec2(20 - 40 * std::cos(2 * (1 - s) * turn),
                              40 * std::sin(2 * (1 - s) * turn));
}

double length_of(const Curve& curve, double from = 0, double to = 1) {
  constexpr int kSteps = 20'000;
  double length = 0;
  for (int i = 0; i < kSteps; ++i)
    length += glm::distance(curve(std::lerp(from, to, double(i) / kSteps)),
                            curve(std::lerp(from, to, double(i + 1) / kSteps)));
  return length;
}

glm::dvec3 place_at(const glm::dvec2& across, double along) {
  const TangentFrame frame(kAlong);
  return kMiddle + across.x * frame.x + across.y * frame.y + along * kAlong;
}

// `roughness` is the largest distance of a corner of the mesh from the curve.
Shape cylinder_over(const Curve& curve, bool inward, double roughness = 0) {
  Shape shape;
  shape.columns = 512;
  shape.rows = 64;
  shape.position = [=](double s, double t) {
    const double place = inward ? 1 - s : s;
    // Both ends of a closed curve get the same number.
    std::mt19937 random(
        static_cast<unsigned>(std::lround(std::fmod(place, 1) * 512) * 1000 + std::lround(t * 64)));
    const double bump = std::uniform_real_distribution(-roughness, roughness)(random);
    const glm::dvec2 across = curve(place);
    return place_at(across + bump * glm::normalize(across), (t - 0.5) * kLength);
  };
  const double length = length_of(curve);
  shape.flat = [=](double s, double t) { return glm::dvec2(s * length, t * kLength); };
  return shape;
}

TreeOf tree_of(const Geometry& geometry) {
  return [&] { return std::make_shared<SearchTree>(std::make_shared<Geometry>(geometry)); };
}

FittedSheet unroll(const Geometry& geometry, FitRequest request = {},
                   const std::optional<double>& cut = {}) {
  request.shape = DevelopedShape::general_cylinder;
  const auto fitted = fit_sheet(tree_of(geometry), geometry, request, cut, "z");
  EXPECT_TRUE(fitted) << fitted.error().detail;
  return fitted ? *fitted : FittedSheet{};
}

glm::dvec2 on_sheet(const RolloutSheet& sheet, const glm::dvec3& world) {
  auto place = sheet.surface.place_of(world);
  while (place.angle < sheet.from - 1e-9) place.angle += kTurn;
  while (place.angle > sheet.to + 1e-9) place.angle -= kTurn;
  return sheet.on_sheet({place.angle, place.slant});
}

struct Example {
  const char* name;
  Curve curve;
  bool inward, closed;
};
const Example kExamples[] = {{"ellipse", ellipse, false, true},
                             {"pipe", ellipse, true, true},
                             {"pillar", square, false, true},
                             {"pointed vault", pointed_arch, true, false}};

TEST(GeneralCylinder, the_sheet_has_the_size_of_the_wall) {
  for (const Example& example : kExamples) {
    const Surface surface =
        test::cut_surface(cylinder_over(example.curve, example.inward), kOneChart, 256);
    const auto [fit, sheet] = unroll(surface.geometry);
    EXPECT_EQ(sheet.surface.shape(), DevelopedShape::general_cylinder);
    EXPECT_EQ(fit.side, example.inward ? RolloutSide::inside : RolloutSide::outside);
    EXPECT_GT(glm::dot(fit.surface.axis, kAlong), 1 - 1e-6) << example.name;
    const double length = length_of(example.curve);
    EXPECT_NEAR(sheet.max.x - sheet.min.x, length, 0.005 * length) << example.name;
    EXPECT_NEAR(sheet.max.y - sheet.min.y, kLength, 1e-3 * kLength) << example.name;
    EXPECT_NEAR(sheet.to - sheet.from < kTurn - 0.1, !example.closed, 0) << example.name;
    EXPECT_LT(fit.deviation, 0.05) << example.name;
  }
}

TEST(GeneralCylinder, lengths_on_the_sheet_are_those_along_the_wall) {
  for (const Example& example : kExamples) {
    const Surface surface =
        test::cut_surface(cylinder_over(example.curve, example.inward), kOneChart, 256);
    const RolloutSheet sheet = unroll(surface.geometry).sheet;
    std::mt19937 random(3);
    std::uniform_real_distribution<double> any(0, 1);
    int compared = 0;
    for (int i = 0; i < 200; ++i) {
      const double from = any(random), to = std::min(1.0, from + 0.3 * any(random));
      const double low = kLength * (any(random) - 0.5), high = kLength * (any(random) - 0.5);
      const glm::dvec2 a = on_sheet(sheet, place_at(example.curve(from), low)),
                       b = on_sheet(sheet, place_at(example.curve(to), high));
      const double around = length_of(example.curve, from, to);
      if (std::abs(a.x - b.x) > 1.5 * around + 1) continue;  // the cut is between the points
      ++compared;
      const double length = std::hypot(around, high - low);
      EXPECT_NEAR(glm::distance(a, b), length, 0.01 * length + 0.1) << example.name;
      // Outside, the viewer sees growing angles to the right.
      EXPECT_EQ(a.x < b.x, !example.inward) << example.name;
    }
    EXPECT_GT(compared, 100) << example.name;
  }
}

TEST(GeneralCylinder, areas_on_the_sheet_are_those_of_the_statistics) {
  for (const Example& example : kExamples)
    for (const Cuts& cuts : {kOneChart, kManyCharts}) {
      const Surface surface =
          test::cut_surface(cylinder_over(example.curve, example.inward), cuts, 512);
      const Geometry& geometry = surface.geometry;
      const glm::dvec3 center = place_at(example.curve(0.4), 5);
      const auto is_painted = [&](const glm::dvec3& place) {
        return glm::distance(place, center) < 16;
      };
      double expected = 0;
      test::for_each_surface_texel(surface.map, [&](std::uint32_t texel) {
        const auto position = surface.map.position(texel / 64, static_cast<int>(texel % 64));
        if (is_painted(geometry.origin + glm::dvec3(position))) expected += surface.map.area[texel];
      });
      ASSERT_GT(expected, 500) << example.name;
      const RolloutSheet sheet = unroll(geometry).sheet;
      const SearchTree tree(std::make_shared<Geometry>(geometry));
      std::mutex mutex;
      std::size_t pixels = 0;
      Progress progress;
      ASSERT_TRUE(trace_rollout(
          tree, geometry, sheet, window_of(sheet, 0.2),
          [&](int, std::span<const std::optional<RolloutHit>> row) {
            const std::lock_guard lock(mutex);
            for (const auto& pixel : row)
              if (pixel && is_painted(geometry.origin + glm::dvec3(pixel->hit.position))) ++pixels;
          },
          progress));
      EXPECT_NEAR(static_cast<double>(pixels) * 0.04, expected, 0.01 * expected) << example.name;
    }
}

TEST(GeneralCylinder, roughness_does_not_make_the_wall_longer) {
  // Without smoothing, the medians would make the section 2.5 % longer.
  const Surface surface = test::cut_surface(cylinder_over(ellipse, false, 0.6), kOneChart, 256);
  const RolloutSheet sheet = unroll(surface.geometry).sheet;
  const double length = length_of(ellipse);
  EXPECT_NEAR(sheet.max.x - sheet.min.x, length, 0.01 * length);
}

TEST(GeneralCylinder, a_hole_in_the_wall_is_bridged) {
  // The wall has a window over the whole length of the axis, so the sheet is open there.
  const Curve open = [](double s) { return ellipse(0.05 + 0.85 * s); };
  const Surface surface = test::cut_surface(cylinder_over(open, false), kOneChart, 256);
  const RolloutSheet sheet = unroll(surface.geometry).sheet;
  const double length = length_of(open);
  EXPECT_NEAR(sheet.max.x - sheet.min.x, length, 0.01 * length);
  EXPECT_LT(sheet.to - sheet.from, kTurn - 0.2);
}

TEST(GeneralCylinder, a_pillar_of_twelve_triangles_can_be_unrolled) {
  Shape box = cylinder_over(square, false);
  box.columns = 4;
  box.rows = 1;
  const Surface surface = test::cut_surface(box, {4, 1, 0, 1}, 256);
  const RolloutSheet sheet = unroll(surface.geometry).sheet;
  EXPECT_NEAR(sheet.max.x - sheet.min.x, 160, 0.5);
}

TEST(GeneralCylinder, shapes_without_a_unique_axis_are_refused) {
  TriangleMesh cube;
  Atlas atlas;
  for (int corner = 0; corner < 8; ++corner)
    cube.positions.emplace_back(corner & 1, corner >> 1 & 1, corner >> 2);
  cube.triangles = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                    2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
  TriangleMesh flat;
  flat.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  flat.triangles = {0, 1, 2, 0, 2, 3};
  for (TriangleMesh* mesh : {&cube, &flat}) {
    atlas.corner_uvs.assign(mesh->triangles.size(), glm::vec2(0.5f));
    const Geometry geometry = build_geometry(*mesh, atlas);
    FitRequest request;
    request.shape = DevelopedShape::general_cylinder;
    const auto fitted = fit_sheet(tree_of(geometry), geometry, request, {}, "z");
    ASSERT_FALSE(fitted);
    EXPECT_EQ(fitted.error().field, "axis");
  }
  // With an axis of the user, a cube is a pillar.
  atlas.corner_uvs.assign(cube.triangles.size(), glm::vec2(0.5f));
  FitRequest request;
  request.axis = {{0.5, 0.5, 0.5}, {0, 0, 1}};
  const RolloutSheet sheet = unroll(build_geometry(cube, atlas), request).sheet;
  EXPECT_NEAR(sheet.max.x - sheet.min.x, 4, 0.01);
}

TEST(CrossSection, arcs_and_angles_are_inverse) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> radius(5, 15), any(-3 * kTurn, 3 * kTurn);
  for (int round = 0; round < 20; ++round) {
    std::vector<double> radii(8 + round);
    for (double& each : radii) each = radius(random);
    const CrossSection section(radii);
    for (int i = 0; i < 50; ++i) {
      const double angle = any(random), arc = section.arc(angle);
      EXPECT_NEAR(section.angle_at(arc), angle, 1e-9);
      EXPECT_NEAR(section.arc(angle + kTurn), arc + section.length(), 1e-9 * std::abs(arc) + 1e-9);
      const double step = 1e-5, stretch = (section.arc(angle + step) - arc) / step;
      EXPECT_GE(stretch, section.min_stretch() * (1 - 1e-3));
      EXPECT_LE(stretch, section.max_stretch() * (1 + 1e-3));
      EXPECT_NEAR(glm::length(section.tangent(angle)), 1, 1e-12);
    }
  }
}

TEST(CrossSection, a_circle_has_the_tangents_of_a_circle) {
  const CrossSection section(std::vector<double>(720, 12.0));
  EXPECT_NEAR(section.length(), kTurn * 12, kTurn * 12 * 1e-5);
  for (double angle = -7; angle < 7; angle += 0.013) {
    EXPECT_NEAR(section.radius(angle), 12, 12 * 1e-5);
    const glm::dvec2 tangent = section.tangent(angle);
    EXPECT_NEAR(tangent.x, -std::sin(angle), 1e-4);
    EXPECT_NEAR(tangent.y, std::cos(angle), 1e-4);
  }
}

}  // namespace
}  // namespace strata::mesh
