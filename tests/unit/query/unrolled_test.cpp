// Areas on unrolled sheets of shapes with formulas, whose atlases have seams in other places than
// the cut of the sheet.
#include "query/conditions/unrolled.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "domain/people/question.h"
#include "query/sampling/profile.h"
#include "support/cut_shapes.h"

namespace strata::query {
namespace {

using mesh::DevelopedFit;
using mesh::FitRequest;
using mesh::RolloutSheet;
using mesh::RolloutSide;
using mesh::SheetArea;
using test::Cuts;
using test::Shape;
using test::Surface;
using Polygons = std::vector<std::vector<glm::dvec2>>;
constexpr double kPi = std::numbers::pi;
constexpr int kResolution = 512;
constexpr Cuts kCuts[] = {{1, 1, 0.4, 1}, {3, 4, 0.7, 0.75}, {7, 5, 1.1, 0.6}};

glm::dvec3 around(double angle, double radius, double along) {
  return {100 + radius * std::cos(angle), -20 + radius * std::sin(angle), 50 + along};
}

// A part of a cone with the slope tan(half angle), or of a cylinder with the slope 0. It covers
// `share` of the turn.
Shape wall(double slope, double share = 1) {
  Shape shape;
  shape.columns = 512;
  shape.rows = 64;
  shape.position = [=](double s, double t) {
    const double along = (t - 0.5) * 40;
    return around(s * share * 2 * kPi, 25 + slope * along, along);
  };
  shape.flat = [=](double s, double t) {
    return glm::dvec2(s * share * 2 * kPi * 25, t * 40 * std::hypot(1.0, slope));
  };
  return shape;
}

// A wall with an outside at the radius 25, an inside at 22, and a rim that falls to the inside.
Shape thick_wall() {
  Shape shape = wall(0);
  shape.position = [](double s, double t) {
    return around(s * 2 * kPi, t <= 0.5 ? 25 : 22, t <= 0.5 ? 80 * t - 20 : 60 - 80 * t);
  };
  shape.flat = [](double s, double t) { return glm::dvec2(s * 2 * kPi * 25, t * 80); };
  return shape;
}

// One and a half turns of a scroll whose faces all point outward. The first half turn, at radii
// from 30 to 28, is in front of the last one, at radii from 26 to 24.
Shape scroll() {
  Shape shape = wall(0);
  shape.position = [](double s, double t) { return around(s * 3 * kPi, 30 - 6 * s, 40 * t - 20); };
  shape.flat = [](double s, double t) { return glm::dvec2(s * 3 * kPi * 27, t * 40); };
  return shape;
}

RolloutSheet sheet_of(const Surface& surface, const FitRequest& request = {},
                      const std::optional<double>& cut = {}) {
  const auto tree_of = [&] {
    return std::make_shared<mesh::SearchTree>(std::make_shared<mesh::Geometry>(surface.geometry));
  };
  const auto fitted = mesh::fit_sheet(tree_of, surface.geometry, request, cut, "z");
  EXPECT_TRUE(fitted) << fitted.error().detail;
  return fitted ? fitted->sheet : RolloutSheet{};
}

TexelSelection select(const Surface& surface, const RolloutSheet& sheet, const SheetArea& area,
                      int threads = 2) {
  const mesh::SearchTree tree(std::make_shared<mesh::Geometry>(surface.geometry));
  const mesh::RolloutRays rays(tree, surface.geometry, sheet);
  return select_unrolled(surface.map, rays, surface.geometry.origin, area, threads);
}

bool has(const TexelSelection& selection, std::uint32_t texel) {
  return (selection[texel / 64] >> texel % 64 & 1u) != 0;
}

double area_of(const Surface& surface, const TexelSelection& selection) {
  return measure_selection(surface.map, &selection).area;
}

// A rectangle around a place of the sheet, along the straight lines of the cone there.
std::vector<glm::dvec2> rectangle(const RolloutSheet& sheet,
                                  const RolloutSheet::SurfacePlace& place, double width,
                                  double height) {
  const glm::dvec2 center = sheet.on_sheet(place), up = sheet.up_at(place.angle);
  const glm::dvec2 right(up.y, -up.x);
  const auto corner = [&](double x, double y) {
    return center + x * width / 2 * right + y * height / 2 * up;
  };
  return {corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1)};
}

// The whole sheet and more.
Polygons everything(const RolloutSheet& sheet) {
  const glm::dvec2 low = sheet.min - 500.0, high = sheet.max + 500.0;
  return {{low, {high.x, low.y}, high, {low.x, high.y}}};
}

TEST(Unrolled, a_rectangle_on_the_sheet_has_its_area_on_the_surface) {
  for (const double slope : {0.0, 0.4, -0.7})
    for (const Cuts& cuts : kCuts) {
      // The rows of texels of the first atlas are parallel to the rectangle, so a side can be
      // longer by a texel.
      const Surface surface = test::cut_surface(wall(slope), cuts, 2 * kResolution);
      const RolloutSheet sheet =
          sheet_of(surface, {}, cuts.columns == 1 ? std::nullopt : std::optional(1.0));
      const double slant = (sheet.slant_from + sheet.slant_to) / 2;
      // In the middle, and across both ends of the cut.
      for (const double angle : {sheet.middle(), sheet.from, sheet.to}) {
        const SheetArea area({rectangle(sheet, {angle, slant}, 50, 30)}, {});
        EXPECT_NEAR(area_of(surface, select(surface, sheet, area)), 1500, 15)
            << slope << " " << cuts.columns << " " << angle;
      }
    }
}

TEST(Unrolled, a_stroke_on_the_sheet_has_its_area_on_the_surface) {
  for (const double slope : {0.0, 0.4}) {
    const Surface surface = test::cut_surface(wall(slope), kCuts[2], kResolution);
    const RolloutSheet sheet = sheet_of(surface);
    const double slant = (sheet.slant_from + sheet.slant_to) / 2;
    for (const double angle : {sheet.middle() + 0.5, sheet.from}) {
      const glm::dvec2 center = sheet.on_sheet({angle, slant}), up = sheet.up_at(angle);
      const SheetArea disc({}, {{{center}, 9}}),
          line({}, {{{center - 8.0 * up, center + 8.0 * up}, 6}});
      EXPECT_NEAR(area_of(surface, select(surface, sheet, disc)), kPi * 81, 0.01 * kPi * 81);
      const double expected = 16 * 12 + kPi * 36;
      EXPECT_NEAR(area_of(surface, select(surface, sheet, line)), expected, 0.01 * expected);
    }
  }
}

TEST(Unrolled, an_area_on_the_sheet_of_a_general_cylinder_has_its_area) {
  // An elliptical column: 30 and 20 wide, with a known length of the way around.
  const auto ellipse = [](double s) {
    return glm::dvec2(30 * std::cos(2 * kPi * s), 20 * std::sin(2 * kPi * s));
  };
  double length = 0;
  for (int i = 0; i < 10'000; ++i)
    length += glm::distance(ellipse(i / 1e4), ellipse((i + 1) / 1e4));
  Shape shape = wall(0);
  shape.position = [=](double s, double t) {
    return glm::dvec3(100, -20, 50) + glm::dvec3(ellipse(s), 40 * t - 20);
  };
  shape.flat = [=](double s, double t) { return glm::dvec2(s * length, t * 40); };
  const Surface surface = test::cut_surface(shape, kCuts[2], 2 * kResolution);
  FitRequest request;
  request.shape = mesh::DevelopedShape::general_cylinder;
  const RolloutSheet sheet = sheet_of(surface, request);
  for (const double angle : {sheet.middle(), sheet.middle() + 0.8, sheet.from, sheet.to}) {
    const SheetArea area({rectangle(sheet, {angle, 0}, 50, 30)}, {});
    EXPECT_NEAR(area_of(surface, select(surface, sheet, area)), 1500, 15) << angle;
  }
  const SheetArea everywhere(everything(sheet), {});
  EXPECT_NEAR(area_of(surface, select(surface, sheet, everywhere)), 40 * length,
              0.01 * 40 * length);
}

TEST(Unrolled, an_inner_wall_is_not_selected_from_the_outside) {
  const Surface surface = test::cut_surface(thick_wall(), kCuts[1], kResolution);
  const auto selected_on = [&](RolloutSide side) {
    FitRequest request;
    request.side = side;
    const RolloutSheet sheet = sheet_of(surface, request);
    return select(surface, sheet, SheetArea(everything(sheet), {}));
  };
  const auto outside = selected_on(RolloutSide::outside), inside = selected_on(RolloutSide::inside);
  int checked = 0;
  test::for_each_surface_texel(surface.map, [&](std::uint32_t texel) {
    const glm::dvec3 place =
        surface.geometry.origin +
        glm::dvec3(surface.map.position(texel / 64, static_cast<int>(texel % 64)));
    const double radius = std::hypot(place.x - 100, place.y + 20);
    if (place.z > 50 + 18.7) return;  // the rim
    ++checked;
    EXPECT_EQ(has(outside, texel), radius > 24) << radius << " " << place.z;
    EXPECT_EQ(has(inside, texel), radius < 24) << radius << " " << place.z;
  });
  EXPECT_GT(checked, 40'000);
}

TEST(Unrolled, surface_behind_other_surface_is_not_selected) {
  const Surface surface = test::cut_surface(scroll(), kCuts[1], kResolution);
  FitRequest request;
  request.axis = {glm::dvec3(100, -20, 50), glm::dvec3(0, 0, 1)};
  request.radius = 27;
  request.side = RolloutSide::outside;
  const RolloutSheet sheet = sheet_of(surface, request);
  const auto selected = select(surface, sheet, SheetArea(everything(sheet), {}));
  int in_front = 0, behind = 0;
  test::for_each_surface_texel(surface.map, [&](std::uint32_t texel) {
    const glm::dvec3 place =
        surface.geometry.origin +
        glm::dvec3(surface.map.position(texel / 64, static_cast<int>(texel % 64)));
    const double radius = std::hypot(place.x - 100, place.y + 20);
    if (std::abs(radius - 26) < 0.05) return;  // at the edge of the surface in front
    EXPECT_EQ(has(selected, texel), radius > 26) << radius;
    ++(radius > 26 ? in_front : behind);
  });
  EXPECT_GT(in_front, 10'000);
  EXPECT_GT(behind, 5'000);
}

TEST(Unrolled, the_rollout_shows_exactly_the_selected_texels) {
  for (const double slope : {0.0, 0.4}) {
    const Surface surface = test::cut_surface(wall(slope), kCuts[2], 256);
    const RolloutSheet sheet = sheet_of(surface);
    const mesh::SearchTree tree(std::make_shared<mesh::Geometry>(surface.geometry));
    const mesh::RolloutRays rays(tree, surface.geometry, sheet);
    const glm::dvec2 middle = (sheet.min + sheet.max) / 2.0;
    const SheetArea area(
        {{{middle.x - 40, middle.y - 12}, {middle.x + 45, middle.y}, middle + 9.0}},
        {{{middle - 30.0, middle}, 5}});
    const auto selected = select(surface, sheet, area);
    EXPECT_EQ(selected, select(surface, sheet, area, 1));
    int checked = 0;
    test::for_each_surface_texel(surface.map, [&](std::uint32_t texel) {
      const glm::vec3 position = surface.map.position(texel / 64, static_cast<int>(texel % 64));
      auto place = sheet.surface.place_of(surface.geometry.origin + glm::dvec3(position));
      place.angle = sheet.middle() + std::remainder(place.angle - sheet.middle(), 2 * kPi);
      const glm::dvec2 on_sheet = sheet.on_sheet({place.angle, place.slant});
      const auto hit = rays.cast(on_sheet);
      if (!hit) return;  // between two triangles, or at the border of the sheet
      ASSERT_LT(glm::distance(hit->hit.position, position), 0.01f);
      EXPECT_EQ(has(selected, texel), area.contains(on_sheet)) << on_sheet.x << " " << on_sheet.y;
      ++checked;
    });
    EXPECT_GT(checked, 0.99 * static_cast<double>(surface.map.surface_texels));
  }
}

TEST(Unrolled, a_wall_with_a_gap_ends_at_its_ends) {
  const Surface surface = test::cut_surface(wall(0, 0.6), kCuts[1], kResolution);
  const RolloutSheet sheet = sheet_of(surface);
  EXPECT_EQ(sheet.beyond_cut(), 0);
  const double slant = (sheet.slant_from + sheet.slant_to) / 2;
  const SheetArea at_end({rectangle(sheet, {sheet.to, slant}, 30, 20)}, {});
  EXPECT_NEAR(area_of(surface, select(surface, sheet, at_end)), 300, 6);
  const SheetArea past_end({rectangle(sheet, {sheet.to + 0.8, slant}, 30, 20)}, {});
  EXPECT_EQ(area_of(surface, select(surface, sheet, past_end)), 0);
}

TEST(Unrolled, the_sheet_of_a_cone_continues_to_the_middle_of_its_gap) {
  RolloutSheet sheet;
  sheet.from = -kPi;
  sheet.to = kPi;
  EXPECT_EQ(sheet.beyond_cut(), kPi);
  sheet.surface.half_angle = -std::asin(0.25);  // the sector covers a quarter of the plane
  EXPECT_EQ(sheet.beyond_cut(), kPi);
  sheet.surface.half_angle = std::asin(0.8);  // both ends get a tenth of the plane
  EXPECT_NEAR(sheet.beyond_cut(), kPi / 4, 1e-12);
}

TEST(Unrolled, a_selection_ends_with_its_question) {
  const Surface surface = test::cut_surface(wall(0), kCuts[0], 256);
  const RolloutSheet sheet = sheet_of(surface);
  const SheetArea area(everything(sheet), {});
  const auto question = std::make_shared<Question>("ada", QuestionLimits{}, nullptr);
  const Question::Scope scope(question);
  question->end({ErrorCode::cancelled, "Canceled", "The request was canceled.", {}});
  EXPECT_THROW(select(surface, sheet, area), QuestionEnded);
}

TEST(UnrolledProfile, a_line_is_on_the_wall_where_the_sheet_shows_it) {
  const auto surface = test::cut_surface(thick_wall(), kCuts[0], kResolution);
  const RolloutSheet sheet = sheet_of(surface);
  const mesh::SearchTree tree(std::make_shared<mesh::Geometry>(surface.geometry));
  const mesh::RolloutRays rays(tree, surface.geometry, sheet);
  // Half a turn at one height, and then up and past the rim.
  const double radius = sheet.surface.radius;
  const std::vector<glm::dvec2> path = {
      {-radius * kPi / 2, 0}, {radius * kPi / 2, 0}, {radius * kPi / 2, 1000}};
  const auto profile = profile_unrolled(rays, surface.geometry.origin, path, 0.5, {});
  ASSERT_TRUE(profile);
  const auto on_wall = static_cast<std::size_t>(std::ceil(radius * kPi / 0.5));
  for (std::size_t i = 0; i <= on_wall; ++i) {
    const auto& point = profile->samples[i].point;
    ASSERT_TRUE(point.hit);
    const glm::dvec2 from_axis(point.position.x - 100, point.position.y + 20);
    EXPECT_NEAR(glm::length(from_axis), 25, 0.01) << "the outside";
    const glm::dvec2 drawn =
        path[0] + (path[1] - path[0]) * (static_cast<double>(i) / static_cast<double>(on_wall));
    const auto place = sheet.surface.place_of(point.position);
    EXPECT_LT(glm::distance(sheet.on_sheet({place.angle, place.slant}), drawn), 0.01);
  }
  EXPECT_NEAR(profile->samples[on_wall].along, 25 * kPi, 0.05);
  EXPECT_FALSE(profile->samples.back().point.hit) << "above the rim";
  EXPECT_EQ(profile_unrolled(rays, surface.geometry.origin, path, 1e-4, {}).error().field,
            "step_mm");
}

}  // namespace
}  // namespace strata::query
