// Borders of painted areas on shapes with known lengths.
#include "query/statistics/perimeter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mesh/surface/boundary_loops.h"
#include "query/statistics/statistics.h"
#include "support/meshes.h"
#include "support/surfaces.h"

namespace strata::query {
namespace {

using test::Surface;
constexpr double kPi = std::numbers::pi;
constexpr ValueClasses kEach{.each = true};

Perimeters measure(const Surface& surface, const std::function<int(glm::vec3)>& value_at,
                   const ValueClasses& classes = kEach, const TexelSelection* within = nullptr) {
  LayerView view;
  view.layer.type = ValueType::u8;
  view.layer.resolution = surface.map.resolution;
  view.snapshot.tiles = test::layer_of(surface.map, value_at);
  const Perimeters one = measure_perimeters(view, surface.map, surface.graph, within, classes, 1);
  const Perimeters two = measure_perimeters(view, surface.map, surface.graph, within, classes, 2);
  EXPECT_EQ(one.all, two.all) << "the same on any number of threads";
  EXPECT_EQ(one.of_class, two.of_class);
  return one;
}

void expect_length(double length, double expected, double share) {
  EXPECT_NEAR(length / expected, 1, share);
}

Surface sheet(double turned, glm::dvec2 stretch = glm::dvec2(1)) {
  mesh::TriangleMesh mesh = test::open_grid(24, 0);
  for (glm::dvec3& p : mesh.positions) {
    const glm::dvec2 at = (glm::dvec2(p) - 0.5) * stretch;
    p = {at.x * std::cos(turned) - at.y * std::sin(turned),
         at.x * std::sin(turned) + at.y * std::cos(turned), 0};
  }
  return test::surface_of("sheet", mesh, 1024);
}

TEST(Perimeter, squares_and_strips_are_as_long_as_their_sides_however_they_lie) {
  for (const double degrees : {0.0, 7.0, 13.3, 22.5, 26.6, 36.0, 45.0}) {
    SCOPED_TRACE(degrees);
    const Surface surface = sheet(degrees * kPi / 180);
    const auto square = measure(
        surface, [](glm::vec3 p) { return std::max(std::abs(p.x), std::abs(p.y)) < 0.25f; });
    expect_length(square.all, 2, 0.02);
    EXPECT_EQ(square.of_class.at(1), square.all);
    const auto strip =
        measure(surface, [](glm::vec3 p) { return std::abs(p.x) < 0.02f && std::abs(p.y) < 0.3f; });
    expect_length(strip.all, 2 * (0.6 + 0.04), 0.02);
  }
}

TEST(Perimeter, texels_that_are_stretched_count_what_they_are_on_the_surface) {
  for (const glm::dvec2 stretch : {glm::dvec2(1), glm::dvec2(3, 1), glm::dvec2(1, 5)}) {
    SCOPED_TRACE(stretch.x / stretch.y);
    const Surface surface = sheet(0.4, stretch);
    for (const float radius : {0.1f, 0.3f}) {
      const auto disc = measure(surface, [&](glm::vec3 p) { return glm::length(p) < radius; });
      expect_length(disc.all, 2 * kPi * radius, 0.02);
    }
  }
}

TEST(Perimeter, two_classes_share_a_border_and_what_is_valid_has_only_its_own) {
  const Surface surface = sheet(0);
  const auto halves = [](glm::vec3 p) { return p.x < 0 ? 1 : 2; };
  const auto each = measure(surface, halves);
  expect_length(each.all, 4, 0.03);  // open edge of the mesh, where seams end
  expect_length(each.of_class.at(1), 3, 0.03);
  expect_length(each.of_class.at(2), 3, 0.03);
  const auto one = measure(surface, halves, {});
  EXPECT_EQ(one.all, each.all);
  EXPECT_EQ(one.of_class.at(0), each.all);
  // Measure only the selected texels.
  TexelSelection within(surface.map.surface_mask.size(), 0);
  test::for_each_surface_texel(surface.map, [&](std::uint32_t texel) {
    if (glm::length(surface.map.position(texel / 64, static_cast<int>(texel % 64))) < 0.2f)
      within[texel / 64] |= std::uint64_t{1} << texel % 64;
  });
  const auto selected = measure(surface, halves, kEach, &within);
  expect_length(selected.all, 2 * kPi * 0.2, 0.02);
  expect_length(selected.of_class.at(1), (kPi + 2) * 0.2, 0.02);
}

TEST(Perimeter, a_disc_on_a_sphere_is_the_same_wherever_it_lies) {
  const Surface surface = test::surface_of("sphere", test::sphere(128), 1024);
  for (const glm::vec3 towards :
       {glm::vec3(0, 0, 1), glm::vec3(1, 0, 0), glm::vec3(-1, 2, 0.5f), glm::vec3(1, -1, -1)})
    for (const float angle : {0.15f, 0.6f, 1.4f}) {
      SCOPED_TRACE(angle);
      const glm::vec3 axis = glm::normalize(towards);
      const auto disc = measure(surface, [&](glm::vec3 p) {
        return glm::dot(glm::normalize(p), axis) > std::cos(angle) ? 9 : 0;
      });
      expect_length(disc.all, 2 * kPi * std::sin(angle), 0.03);
    }
}

TEST(Perimeter, rings_of_a_torus_are_followed_across_seams) {
  const Surface surface = test::surface_of("torus", test::torus(128), 1024);
  const auto half = measure(surface, [](glm::vec3 p) { return p.x > 0 ? 1 : 2; });
  expect_length(half.of_class.at(1), 2 * 2 * kPi * 0.4, 0.03);
  expect_length(half.of_class.at(2), 2 * 2 * kPi * 0.4, 0.03);
  const auto upper = measure(surface, [](glm::vec3 p) { return p.z > 0 ? 1 : 0; });
  expect_length(upper.all, 2 * kPi * (1.4 + 0.6), 0.03);
}

TEST(Perimeter, seams_are_no_borders_and_nothing_has_none) {
  for (const auto& [name, mesh] : test::mesh_classes()) {
    SCOPED_TRACE(name);
    const Surface surface = test::surface_of(name, mesh, 512);
    EXPECT_EQ(measure(surface, [](glm::vec3) { return 0; }).all, 0);
    const double around = measure(surface, [](glm::vec3) { return 1; }).all;
    const mesh::Connectivity connectivity(mesh.triangles, mesh.positions.size());
    const bool is_closed = mesh::boundary_loops(connectivity).empty();
    if (is_closed)
      EXPECT_EQ(around, 0);
    else
      EXPECT_GT(around, 1);
  }
}

TEST(Perimeter, statistics_tell_it_in_metres) {
  const Surface surface = sheet(0.2);
  LayerView view;
  view.layer.type = ValueType::u8;
  view.layer.resolution = surface.map.resolution;
  view.snapshot.tiles =
      test::layer_of(surface.map, [](glm::vec3 p) { return glm::length(p) < 0.3f ? 4 : 0; });
  const auto found = statistics(view, surface.map, glm::dvec3(0), 0.001,
                                {.perimeter = true, .graph = &surface.graph});
  ASSERT_TRUE(found.perimeter_m);
  expect_length(*found.perimeter_m, 2 * kPi * 0.0003, 0.02);
  EXPECT_EQ(found.keys.at(4).perimeter_m, found.perimeter_m);
  EXPECT_FALSE(found.pieces);
}

}  // namespace
}  // namespace strata::query
