// Dimensions: what they measure, and the places of their lines and texts.
#include "figure/dimension.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "figure/text.h"

namespace strata::figure {
namespace {

const Box kDrawing{{10, 10}, {180, 120}};

glm::dvec2 along(const Dimension::Line& line) { return line.second - line.first; }

TEST(Dimension, MeasuresTheDistanceOrItsParts) {
  const glm::dvec2 from(40, 60), to(70, 20);
  EXPECT_EQ(measured_mm({from, to, DimensionDirection::aligned}), 50);
  EXPECT_EQ(measured_mm({from, to, DimensionDirection::horizontal}), 30);
  EXPECT_EQ(measured_mm({to, from, DimensionDirection::vertical}), 40);
}

TEST(Dimension, HasALineAsLongAsWhatItMeasuresAndTextThatCanBeRead) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> x(40, 160), y(40, 100);
  for (int round = 0; round < 300; ++round)
    for (const auto direction : {DimensionDirection::aligned, DimensionDirection::horizontal,
                                 DimensionDirection::vertical}) {
      const DimensionPoints points{
          {x(random), y(random)}, {x(random), y(random)}, direction, "5 m"};
      const auto placed = place_dimensions({points}, kDrawing);
      if (measured_mm(points) < 0.5) {
        EXPECT_TRUE(placed.empty());
        continue;
      }
      ASSERT_EQ(placed.size(), 1u);
      const Dimension& dimension = placed.front();
      EXPECT_EQ(dimension.text, "5 m");
      const Dimension::Line& line = dimension.lines.back();
      EXPECT_NEAR(glm::length(along(line)), measured_mm(points), 1e-9);
      EXPECT_EQ(dimension.ticks.size(), 2u);
      EXPECT_LT(
          glm::distance((dimension.ticks[0].first + dimension.ticks[0].second) / 2.0, line.first),
          1e-9);
      // extension lines are perpendicular to the line, and lead from the points
      ASSERT_EQ(dimension.lines.size(), 3u);
      for (int i = 0; i < 2; ++i) {
        const Dimension::Line& extension = dimension.lines[static_cast<std::size_t>(i)];
        EXPECT_NEAR(glm::dot(along(extension), along(line)), 0, 1e-6);
        EXPECT_NEAR(glm::distance(extension.first, i == 0 ? points.from : points.to), 1, 1e-9);
        EXPECT_GE(glm::length(along(extension)), 8 - 1 + 1.5 - 1e-9);
      }
      // the text is above the line and is read from below or from the right
      EXPECT_GT(dimension.angle, -90 + 1e-6);
      EXPECT_LE(dimension.angle, 90 + 1e-6);
      const double turn = dimension.angle * M_PI / 180;
      const glm::dvec2 reading(std::cos(turn), -std::sin(turn)), up(reading.y, -reading.x);
      EXPECT_NEAR(std::abs(glm::dot(reading, glm::normalize(along(line)))), 1, 1e-9);
      const glm::dvec2 middle = (line.first + line.second) / 2.0;
      EXPECT_NEAR(glm::dot(dimension.at - middle, up), 0.8, 1e-9);
      EXPECT_NEAR(glm::dot(dimension.at - middle, reading), 0, 1e-9);
    }
}

TEST(Dimension, LinesAreOutwardAndInsideTheDrawing) {
  const auto line_of = [](const glm::dvec2& from, const glm::dvec2& to,
                          DimensionDirection direction) {
    return place_dimensions({{from, to, direction, "1 m"}}, kDrawing).front().lines.back();
  };
  EXPECT_EQ(line_of({50, 100}, {90, 110}, DimensionDirection::horizontal).first.y, 118);
  EXPECT_EQ(line_of({50, 40}, {90, 30}, DimensionDirection::horizontal).first.y, 22);
  EXPECT_EQ(line_of({30, 40}, {40, 80}, DimensionDirection::vertical).first.x, 22);
  // not outside the drawing
  EXPECT_EQ(line_of({50, 124}, {90, 124}, DimensionDirection::horizontal).first.y, 116);
  EXPECT_EQ(line_of({14, 40}, {14, 80}, DimensionDirection::aligned).first.x, 22);
}

TEST(Dimension, LinesAndTextsDoNotOverlap) {
  std::vector<DimensionPoints> points;
  for (int i = 0; i < 4; ++i)  // nested lengths
    points.push_back(
        {{60.0 - 5 * i, 80}, {120.0 + 5 * i, 80}, DimensionDirection::horizontal, "100 cm"});
  const auto placed = place_dimensions(points, kDrawing);
  ASSERT_EQ(placed.size(), 4u);
  for (std::size_t i = 0; i < placed.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      EXPECT_GE(std::abs(placed[i].lines.back().first.y - placed[j].lines.back().first.y), 5.9);
  // short lengths are nearer to their points, in any order
  for (int round = 0; round < 2; ++round) {
    auto nested = place_dimensions(points, kDrawing);
    std::ranges::sort(nested, {},
                      [](const Dimension& each) { return glm::length(along(each.lines.back())); });
    for (std::size_t i = 1; i < nested.size(); ++i)
      EXPECT_GT(nested[i].lines.back().first.y, nested[i - 1].lines.back().first.y);
    std::ranges::reverse(points);
  }
  // a chain is one line
  const auto chain =
      place_dimensions({{{40, 80}, {70, 80}, DimensionDirection::horizontal, "3 m"},
                        {{70, 84}, {110, 84}, DimensionDirection::horizontal, "4 m"}},
                       kDrawing);
  EXPECT_NEAR(chain[0].lines.back().first.y, chain[1].lines.back().first.y, 4.1);
}

TEST(Dimension, SeenFromItsEndIsLeftOut) {
  EXPECT_TRUE(place_dimensions({{{50, 50}, {50, 50.2}, DimensionDirection::aligned, "0"},
                                {{50, 50}, {50, 90}, DimensionDirection::horizontal, "0"}},
                               kDrawing)
                  .empty());
}

TEST(Dimension, GroupsAreClippedAtTheDrawing) {
  const Group group = dimension_group(
      place_dimensions({{{0, 0}, {400, 300}, DimensionDirection::aligned, "far"}}, kDrawing),
      kDrawing);
  ASSERT_TRUE(group.clip);
  EXPECT_EQ(group.clip->corner, kDrawing.corner);
  int lines = 0, texts = 0;
  for (const Item& item : group.items) {
    lines += std::holds_alternative<Path>(item);
    texts += std::holds_alternative<Words>(item);
  }
  EXPECT_EQ(lines, 5);
  EXPECT_EQ(texts, 1);
}

}  // namespace
}  // namespace strata::figure
