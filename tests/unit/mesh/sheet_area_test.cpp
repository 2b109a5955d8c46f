// The area of polygons and strokes: brute force over their edges and segments.
#include "mesh/rollout/sheet_area.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "domain/people/question.h"

namespace strata::mesh {
namespace {

using Polygons = std::vector<std::vector<glm::dvec2>>;
using Strokes = std::vector<SheetArea::Stroke>;

double distance_to(const glm::dvec2& point, const glm::dvec2& from, const glm::dvec2& to) {
  double least = glm::distance(point, from);
  constexpr int kSteps = 2000;
  for (int i = 1; i <= kSteps; ++i)
    least = std::min(least, glm::distance(point, glm::mix(from, to, double(i) / kSteps)));
  return least;
}

TEST(SheetArea, contains_the_points_near_a_path) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> at(-50, 50), any(0, 1);
  for (const std::size_t points : {1u, 2u, 9u}) {
    Strokes strokes(3);
    for (auto& stroke : strokes) {
      stroke.radius = 2 + 15 * any(random);
      for (std::size_t i = 0; i < points; ++i) stroke.path.emplace_back(at(random), at(random));
    }
    const SheetArea area({}, strokes);
    int inside = 0, checked = 0;
    for (int i = 0; i < 500; ++i) {
      const glm::dvec2 point(1.4 * at(random), 1.4 * at(random));
      double over = 1e9;  // the distance to the nearest border of a stroke, negative inside
      for (const auto& stroke : strokes)
        for (std::size_t k = 0; k < points; ++k)
          over =
              std::min(over, distance_to(point, stroke.path[k == 0 ? 0 : k - 1], stroke.path[k]) -
                                 stroke.radius);
      if (std::abs(over) < 0.01) continue;  // the brute force is exact to this distance
      ++checked;
      inside += over < 0;
      ASSERT_EQ(area.contains(point), over < 0) << points << " at " << point.x << " " << point.y;
    }
    EXPECT_GT(inside, 20);
    EXPECT_GT(checked - inside, 20);
  }
}

TEST(SheetArea, joins_polygons_and_strokes) {
  const Polygons polygons{{{0, 0}, {10, 0}, {10, 10}, {0, 10}},
                          {{5, 5}, {15, 5}, {15, 15}, {5, 15}}};
  const SheetArea area(polygons, {{{{30, 0}, {40, 0}}, 3}});
  EXPECT_TRUE(area.contains({2, 2}));
  EXPECT_TRUE(area.contains({7, 7}));  // in both polygons
  EXPECT_TRUE(area.contains({12, 12}));
  EXPECT_TRUE(area.contains({35, 2.9}));
  EXPECT_FALSE(area.contains({35, 3.1}));
  EXPECT_FALSE(area.contains({20, 5}));
  EXPECT_EQ(area.low(), glm::dvec2(0, -3));
  EXPECT_EQ(area.high(), glm::dvec2(43, 15));
}

TEST(SheetArea, without_parts_contains_nothing) {
  const SheetArea area({}, {});
  EXPECT_FALSE(area.contains({0, 0}));
  EXPECT_GT(area.low().x, area.high().x);
}

TEST(SheetArea, ends_with_its_question) {
  const auto question = std::make_shared<Question>("ada", QuestionLimits{}, nullptr);
  const Question::Scope scope(question);
  question->end({ErrorCode::cancelled, "Canceled", "The request was canceled.", {}});
  EXPECT_THROW(SheetArea({}, {{{{0, 0}}, 1}}), QuestionEnded);
}

}  // namespace
}  // namespace strata::mesh
