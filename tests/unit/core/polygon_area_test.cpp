#include "core/polygon_area.h"

#include <gtest/gtest.h>

#include <random>

namespace strata {
namespace {

using Rings = std::vector<std::vector<glm::dvec2>>;

// Counts, edge by edge, how often a ray to the right crosses the outline.
bool contains_by_crossings(const Rings& rings, const glm::dvec2& p) {
  bool inside = false;
  for (const auto& ring : rings)
    for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
      const glm::dvec2 a = ring[i], b = ring[j];
      if ((a.y > p.y) != (b.y > p.y) && p.x < (b.x - a.x) * (p.y - a.y) / (b.y - a.y) + a.x)
        inside = !inside;
    }
  return inside;
}

TEST(PolygonArea, contains_what_a_ray_leaves_an_odd_number_of_times) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> at(-50, 150);
  for (const std::size_t points : {3u, 4u, 17u, 400u, 4096u}) {
    Rings rings(points > 100 ? 1 : 3);
    for (auto& ring : rings)
      for (std::size_t i = 0; i < points; ++i) ring.emplace_back(at(random), at(random));
    const PolygonArea area(rings);
    int inside = 0;
    for (int i = 0; i < 3000; ++i) {
      const glm::dvec2 p(at(random), at(random));
      ASSERT_EQ(area.contains(p), contains_by_crossings(rings, p))
          << points << " at " << p.x << " " << p.y;
      inside += area.contains(p);
    }
    EXPECT_GT(inside, 0);
  }
}

TEST(PolygonArea, a_ring_in_a_ring_is_a_hole) {
  const PolygonArea area({{{0, 0}, {10, 0}, {10, 10}, {0, 10}}, {{4, 4}, {6, 4}, {6, 6}, {4, 6}}});
  EXPECT_TRUE(area.contains({1, 5}));
  EXPECT_FALSE(area.contains({5, 5}));
  EXPECT_TRUE(area.contains({9, 5}));
  EXPECT_EQ(area.low(), glm::dvec2(0, 0));
  EXPECT_EQ(area.high(), glm::dvec2(10, 10));
}

TEST(PolygonArea, neighbours_share_no_point_of_their_border_and_leave_none_out) {
  const PolygonArea left({{{0, 0}, {5, 0}, {5, 8}, {0, 8}}}),
      right({{{5, 0}, {9, 0}, {9, 8}, {5, 8}}});
  for (double y = 0.25; y < 8; y += 0.5)
    EXPECT_NE(left.contains({5, y}), right.contains({5, y})) << y;
}

TEST(PolygonArea, without_area_contains_nothing) {
  EXPECT_FALSE(PolygonArea(Rings{}).contains({0, 0}));
  EXPECT_FALSE(PolygonArea({{{1, 1}}}).contains({1, 1}));
  EXPECT_FALSE(PolygonArea({{{0, 0}, {4, 4}}}).contains({2, 2}));
  EXPECT_FALSE(PolygonArea({{{0, 3}, {5, 3}, {9, 3}}}).contains({4, 3}));
}

TEST(PolygonArea, with_huge_coordinates_is_still_one) {
  const PolygonArea area({{{-1e6, -1e6}, {1e6, -1e6}, {1e6, 1e6}, {-1e6, 1e6}}});
  EXPECT_TRUE(area.contains({640, 360}));
  EXPECT_FALSE(area.contains({2e6, 0}));
}

}  // namespace
}  // namespace strata
