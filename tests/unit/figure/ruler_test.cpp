// The rulers of rollouts: their steps, and the places of their ticks, computed from the radius and
// the scale alone.
#include "figure/ruler.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/trigonometric.hpp>
#include <numbers>
#include <string>

namespace strata::figure {
namespace {

constexpr double kPi = std::numbers::pi;

// A surface around the z axis whose slants begin at `low`, 1 : scale on paper. A unit is a
// millimeter on the object.
UnrolledDrawing drawing_of(double radius, double half_angle, double low, double high, double scale,
                           const Box& area, double from = -kPi, double to = kPi) {
  mesh::RolloutSheet sheet;
  sheet.surface.radius = radius;
  sheet.surface.half_angle = half_angle;
  sheet.from = from;
  sheet.to = to;
  sheet.slant_from = low;
  sheet.slant_to = high;
  sheet.min = {sheet.on_sheet({from, low}).x, low};
  sheet.max = {sheet.on_sheet({to, low}).x, high};
  UnrolledDrawing drawing{sheet, (sheet.min + sheet.max) / 2.0, scale, 1, low, area};
  return drawing;
}

struct Tick {
  glm::dvec2 from, to;
  std::string text;  // empty: no label
};
// Returns the ticks of a ruler. The label of a tick follows it.
std::vector<Tick> ticks_of(const UnrolledDrawing& drawing, const std::string& id) {
  std::vector<Tick> ticks;
  for (const Group& group : ruler_groups(drawing)) {
    if (group.id != id) continue;
    for (const Item& item : group.items)
      if (const auto* path = std::get_if<Path>(&item))
        ticks.push_back({path->points[0], path->points[1], {}});
      else
        ticks.back().text = std::get<Words>(item).text;
  }
  return ticks;
}

std::vector<Tick> labeled(std::vector<Tick> ticks) {
  std::erase_if(ticks, [](const Tick& tick) { return tick.text.empty(); });
  return ticks;
}

std::vector<std::string> texts_of(const std::vector<Tick>& ticks) {
  std::vector<std::string> texts;
  for (const Tick& tick : ticks) texts.push_back(tick.text);
  return texts;
}

TEST(Ruler, label_steps_are_readable_multiples_of_tick_steps) {
  for (double mm = 0.003; mm < 3000; mm *= 1.07)
    for (const RulerSteps& steps : {angle_steps(mm), length_steps(mm)}) {
      const double count = steps.label / steps.tick;
      EXPECT_NEAR(count, std::round(count), 1e-9);
      EXPECT_LE(count, 15);
      if (steps.label < 360) {
        EXPECT_GE(steps.label * mm, 8);
      }
      EXPECT_GE(steps.tick * mm, std::min(1.4, steps.label * mm));
    }
  // 1° is 0.349 mm on the paper: 30° would be 10.5 mm.
  EXPECT_EQ(angle_steps(40 * kPi / 180 / 2).label, 45);
  EXPECT_EQ(angle_steps(40 * kPi / 180 / 2).tick, 5);
  EXPECT_EQ(angle_steps(40 * kPi / 180).label, 30);
  EXPECT_EQ(length_steps(0.5).label, 20);
  EXPECT_EQ(length_steps(0.5).tick, 5);
}

TEST(Ruler, a_turn_of_a_cylinder_is_as_long_as_its_circumference) {
  const Box area{{24, 17}, {160, 120}};
  for (const double scale : {1.0, 2.0, 2.5})
    for (const double radius : {12.0, 25.0}) {
      const UnrolledDrawing drawing = drawing_of(radius, 0, 5, 65, scale, area);
      const auto ticks = labeled(ticks_of(drawing, "angle-ruler"));
      ASSERT_GE(ticks.size(), 3u);
      EXPECT_EQ(ticks.front().text, "180°");
      EXPECT_EQ(ticks.back().text, "180°");
      EXPECT_NEAR(ticks.back().from.x - ticks.front().from.x, 2 * kPi * radius / scale, 1e-9);
      for (const Tick& tick : ticks_of(drawing, "angle-ruler")) {
        // Each tick is at a whole degree of the formula, on the lower or upper edge.
        const double degrees = (tick.from.x - 104) * scale / radius * 180 / kPi;
        EXPECT_NEAR(degrees, std::round(degrees), 1e-6);
        EXPECT_EQ(tick.from.x, tick.to.x);
        EXPECT_NEAR(std::abs(tick.from.y - 77), 30 / scale, 1e-9);
        EXPECT_GT(std::abs(tick.to.y - 77), 30 / scale);
        if (!tick.text.empty()) {
          const auto expected = static_cast<int>(std::lround(degrees) + 360) % 360;
          EXPECT_EQ(tick.text, std::to_string(expected) + "°");
          EXPECT_GT(tick.from.y, 77);
        }
      }
    }
}

TEST(Ruler, lengths_begin_at_the_chosen_slant) {
  const UnrolledDrawing drawing = drawing_of(25, 0, 5, 65, 2, {{24, 17}, {160, 120}});
  const auto ticks = labeled(ticks_of(drawing, "length-ruler"));
  const std::vector<std::string> expected{"0", "20", "40", "60 mm"};
  EXPECT_EQ(texts_of(ticks), expected);
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    EXPECT_NEAR(ticks[i].from.x, 104 - kPi * 25 / 2, 1e-9);
    EXPECT_LT(ticks[i].to.x, ticks[i].from.x);
    EXPECT_NEAR(ticks[i].from.y, 77 + 15 - 10 * static_cast<double>(i), 1e-9);
  }
}

TEST(Ruler, long_lengths_are_in_metres) {
  const UnrolledDrawing drawing = drawing_of(2500, 0, 0, 4500, 200, {{24, 17}, {160, 120}});
  EXPECT_EQ(texts_of(labeled(ticks_of(drawing, "length-ruler"))),
            (std::vector<std::string>{"0", "2", "4 m"}));
}

TEST(Ruler, the_angles_of_the_inside_grow_to_the_left) {
  UnrolledDrawing drawing = drawing_of(25, 0, 0, 60, 1, {{0, 0}, {200, 120}}, 0, 1.5);
  const auto outside = labeled(ticks_of(drawing, "angle-ruler"));
  drawing.sheet.side = mesh::RolloutSide::inside;
  const auto inside = labeled(ticks_of(drawing, "angle-ruler"));
  EXPECT_EQ(outside.front().text, "0°");
  EXPECT_LT(outside.front().from.x, outside.back().from.x);
  EXPECT_EQ(texts_of(inside), texts_of(outside));
  EXPECT_GT(inside.front().from.x, inside.back().from.x);
  // The labels of the lengths stay at the left.
  for (const Tick& tick : labeled(ticks_of(drawing, "length-ruler"))) {
    EXPECT_LT(tick.to.x, tick.from.x);
    EXPECT_LT(tick.from.x, 100);
  }
}

TEST(Ruler, a_large_cylinder_has_its_rulers_at_the_borders_of_the_area) {
  const Box area{{24, 17}, {160, 120}};
  const UnrolledDrawing drawing = drawing_of(200, 0, 0, 900, 1, area);
  const glm::dvec2 end = area.corner + area.size;
  const auto angles = ticks_of(drawing, "angle-ruler"), lengths = ticks_of(drawing, "length-ruler");
  EXPECT_GT(labeled(angles).size(), 3u);
  EXPECT_GT(labeled(lengths).size(), 5u);
  for (const Tick& tick : angles)
    EXPECT_LT(std::min(std::abs(tick.from.y - area.corner.y), std::abs(tick.from.y - end.y)), 1e-9);
  for (const Tick& tick : lengths)
    EXPECT_LT(std::min(std::abs(tick.from.x - area.corner.x), std::abs(tick.from.x - end.x)), 1e-9);
}

TEST(Ruler, the_ticks_of_a_cone_are_on_its_arcs_and_slants) {
  for (const double half_angle : {0.2, -0.2}) {
    // The cone begins 50 mm from its tip and has a slant of 60 mm.
    const double sine = std::abs(std::sin(half_angle)), low = half_angle > 0 ? 50 : -110;
    UnrolledDrawing drawing =
        drawing_of(100 * sine, half_angle, 0, 0, 1, {{0, 0}, {400, 400}}, -1, 1);
    const double apex = drawing.sheet.surface.apex();
    drawing.sheet.slant_from = apex + low;
    drawing.sheet.slant_to = apex + low + 60;
    drawing.zero_slant = apex;
    drawing.center = {0, apex};  // the tip is in the middle of the paper
    const glm::dvec2 tip(200, 200);
    std::size_t long_arc = 0;
    for (const Tick& tick : ticks_of(drawing, "angle-ruler")) {
      const glm::dvec2 from = tick.from - tip;
      const double slant = glm::length(from);
      EXPECT_LT(std::min(std::abs(slant - 50), std::abs(slant - 110)), 1e-9);
      // The tick points from the surface, in the direction of the slant.
      const glm::dvec2 out = tick.to - tick.from;
      EXPECT_NEAR(glm::dot(glm::normalize(out), from / slant), slant > 80 ? 1 : -1, 1e-9);
      // The angle on the sheet is the angle around the axis times the sine.
      const double degrees =
          glm::degrees(std::atan2(from.x, half_angle > 0 ? -from.y : from.y)) / sine;
      EXPECT_NEAR(degrees, std::round(degrees), 1e-6);
      EXPECT_LE(std::abs(degrees), glm::degrees(1.0));
      if (tick.text.empty()) continue;
      ++long_arc;
      EXPECT_NEAR(slant, 110, 1e-9);
      EXPECT_EQ(tick.text, std::to_string((std::lround(degrees) + 360) % 360) + "°");
    }
    EXPECT_GE(long_arc, 3u);
    const auto lengths = labeled(ticks_of(drawing, "length-ruler"));
    ASSERT_GE(lengths.size(), 5u);
    for (const Tick& tick : lengths) {
      EXPECT_NEAR(glm::length(tick.from - tip), std::abs(std::stod(tick.text)), 1e-9);
      EXPECT_NEAR(glm::dot(tick.to - tick.from, tick.from - tip), 0, 1e-9);
      EXPECT_LT(tick.from.x, 200);
    }
  }
}

TEST(Ruler, the_rulers_of_a_huge_cone_have_few_ticks) {
  const UnrolledDrawing drawing = drawing_of(1e6, 0.3, 0, 1e6, 0.01, {{24, 17}, {160, 120}});
  std::size_t items = 0;
  for (const Group& group : ruler_groups(drawing)) items += group.items.size();
  EXPECT_LT(items, 1000u);
}

}  // namespace
}  // namespace strata::figure
