#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "mesh/analysis/section_area.h"
#include "support/solids.h"

namespace strata {
namespace {

using test::add, test::ball, test::box, test::geometry_of;

double area(const mesh::TriangleMesh& mesh, const std::vector<glm::dvec4>& planes,
            std::size_t which = 0) {
  const auto areas = mesh::cut_areas(geometry_of(mesh), planes);
  EXPECT_EQ(areas.size(), planes.size());
  EXPECT_TRUE(areas.at(which).area) << "the outline is open";
  return areas.at(which).area.value_or(-1);
}

constexpr double kPi = std::numbers::pi;

TEST(SectionArea, of_a_ball_is_that_of_the_circle_at_each_height) {
  for (const double height : {0.0, 0.3, -0.9, 0.99})
    for (const glm::dvec3 normal : {glm::dvec3(0, 0, 1), {1, 0, 0}, {-3, 2, 5}}) {
      SCOPED_TRACE(height);
      const double circle = kPi * (1 - height * height);
      EXPECT_NEAR(area(ball(), {{normal, -height * glm::length(normal)}}), circle, 0.003 * kPi);
    }
  EXPECT_EQ(area(ball(), {{0, 0, 1, -2}}), 0) << "the plane does not meet the ball";
}

TEST(SectionArea, of_a_box_is_exact_far_from_the_world_s_origin_and_for_any_winding) {
  const glm::dvec3 low(4e6, 5e5, 100), high = low + glm::dvec3(2, 3, 4);
  auto inside_out = box(low, high);
  for (std::size_t i = 0; i < inside_out.triangles.size(); i += 3)
    std::swap(inside_out.triangles[i], inside_out.triangles[i + 1]);
  for (const auto& mesh : {box(low, high), inside_out}) {
    EXPECT_NEAR(area(mesh, {{0, 0, 1, -101.5}}), 6, 1e-6);
    EXPECT_NEAR(area(mesh, {{0, -7, 0, 7 * (5e5 + 1)}}), 8, 1e-6);
    EXPECT_NEAR(area(mesh, {{-1, 0, 0, low.x}}), 12, 1e-6) << "at the box's own side";
    EXPECT_EQ(area(mesh, {{1, 0, 0, -low.x}}), 0) << "nothing is cut away";
  }
}

TEST(SectionArea, leaves_out_a_hollow) {
  auto hollow = ball();
  add(hollow, ball(), 0.5, true);
  EXPECT_NEAR(area(hollow, {{0, 1, 0, 0}}), kPi * 0.75, 0.01);
}

TEST(SectionArea, adds_up_separate_parts) {
  auto two = box({0, 0, 0}, {1, 1, 1});
  add(two, box({2, 0, 0}, {3, 2, 1}), 1, false);
  EXPECT_NEAR(area(two, {{0, 0, 1, -0.5}}), 3, 1e-9);
}

TEST(SectionArea, is_only_what_the_other_planes_keep) {
  const auto cube = box({0, 0, 0}, {4, 4, 4});
  const std::vector<glm::dvec4> planes{{1, 0, 0, -1}, {-1, 0, 0, 3}, {0, 1, 0, -1},
                                       {0, -1, 0, 2}, {0, 0, 1, -1}, {0, 0, -1, 4}};
  EXPECT_NEAR(area(cube, planes, 0), 1 * 3, 1e-9);
  EXPECT_NEAR(area(cube, planes, 3), 2 * 3, 1e-9);
  EXPECT_NEAR(area(cube, planes, 4), 2 * 1, 1e-9);
  EXPECT_NEAR(area(cube, {{1, 0, 0, -1}, {1, 0, 0, -2}}), 0, 1e-9) << "all of it is cut away";
  EXPECT_NEAR(area(cube, {{1, 0, 0, -1}, {1, 1, 0, -3}}), 8, 1e-9) << "a slanted plane";
  EXPECT_NEAR(area(ball(), {{0, 0, 1, 0}, {1, 0, 0, 0}}), kPi / 2, 0.005);
}

TEST(SectionArea, is_unknown_where_the_surface_is_open) {
  auto open = box({0, 0, 0}, {1, 1, 1});
  open.triangles.resize(open.triangles.size() - 6);  // removes the right side
  EXPECT_FALSE(
      mesh::cut_areas(geometry_of(open), std::vector<glm::dvec4>{{0, 0, 1, -0.4}})[0].area);
  EXPECT_NEAR(area(open, {{1, 0, 0, -0.5}}), 1, 1e-9) << "this cut does not meet the hole";
}

TEST(SectionArea, closes_a_small_crack) {
  auto cracked = ball();
  // Remove the triangles of one column in one row.
  cracked.triangles.erase(cracked.triangles.begin() + 600, cracked.triangles.begin() + 606);
  EXPECT_NEAR(area(cracked, {{0, 0, 1, 0.02}}), kPi, 0.01);
  EXPECT_NEAR(area(cracked, {{0, 1, 0, 0.02}}), kPi, 0.01);
}

}  // namespace
}  // namespace strata
