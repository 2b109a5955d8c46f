// Drawings to scale: their axes, the parts in which they are rendered, and the positions of points
// on paper.
#include "figure/drawing.h"

#include <gtest/gtest.h>

#include <cmath>

#include "domain/scene/up.h"

namespace strata::figure {
namespace {

Drawing some_drawing(const Plane& plane) {
  Drawing drawing;
  drawing.plane = plane;
  drawing.center = {1.5, -2};
  drawing.near = -10;
  drawing.far = 20;
  drawing.scale = 20;
  drawing.metres_per_unit = 0.01;
  drawing.dpi = 300;
  drawing.width = 3271;
  drawing.height = 2003;
  return drawing;
}

// Returns the pixel of a point in a part, relative to the top left corner of the drawing.
glm::dvec2 pixel_of(const Part& part, const glm::dvec3& world) {
  const glm::dvec4 clip = part.camera.projection * part.camera.view * glm::dvec4(world, 1);
  return {part.x - part.margin + (clip.x / clip.w + 1) / 2 * (part.width + 2 * part.margin),
          part.y - part.margin + (1 - clip.y / clip.w) / 2 * (part.height + 2 * part.margin)};
}

// Returns the position of a point on paper, computed from the scale alone: in millimeters from the
// top left corner of the drawing, y downwards.
glm::dvec2 on_paper(const Drawing& drawing, const glm::dvec3& world) {
  const glm::dvec3 drawn = drawing.plane.of(world);
  const glm::dvec2 middle_mm = glm::dvec2(drawing.width, drawing.height) * (25.4 / drawing.dpi / 2);
  const double mm_per_unit = drawing.metres_per_unit * 1000 / drawing.scale;
  return middle_mm +
         glm::dvec2(drawn.x - drawing.center.x, drawing.center.y - drawn.y) * mm_per_unit;
}

TEST(Plane, AxesAreAFrameThatLooksAsItsNameSays) {
  for (const std::string_view up : kUpDirections)
    for (const Direction direction : {Direction::top, Direction::bottom, Direction::front,
                                      Direction::back, Direction::left, Direction::right}) {
      const Plane plane = plane_from(direction, up);
      EXPECT_EQ(glm::cross(plane.right, plane.up), -plane.into);
      const glm::dvec3 above = up_frame(up).up;
      const double along = glm::dot(plane.into, above);
      EXPECT_EQ(along, direction == Direction::top ? -1 : direction == Direction::bottom ? 1 : 0);
      if (along == 0) {
        EXPECT_EQ(plane.up, above);
      }
    }
  // The model is upside down, rotated about the right axis of the drawing. The front view then
  // shows the back of the model upside down.
  EXPECT_EQ(plane_from(Direction::front, "-z").into, glm::dvec3(0, -1, 0));
  EXPECT_EQ(plane_from(Direction::front, "-z").right, glm::dvec3(1, 0, 0));
  EXPECT_EQ(plane_from(Direction::top, "-y").into, glm::dvec3(0, 1, 0));
  const Plane plan = plane_from(Direction::top, "z");
  EXPECT_EQ(plan.right, glm::dvec3(1, 0, 0));
  EXPECT_EQ(plan.up, glm::dvec3(0, 1, 0));
  EXPECT_EQ(plane_from(Direction::front, "z").into, glm::dvec3(0, 1, 0));
  EXPECT_EQ(plane_from(Direction::right, "z").into, glm::dvec3(-1, 0, 0));
  EXPECT_EQ(plane_from(Direction::left, "z").into, glm::dvec3(1, 0, 0));
}

TEST(Plane, OfAFaceSeesItSquareAndUpright) {
  for (const glm::dvec3 normal : {glm::dvec3(1, 2, 0.5), glm::dvec3(0, -3, 0), glm::dvec3(0, 0, 7),
                                  glm::dvec3(1e-9, 0, -1)}) {
    const Plane plane = plane_square_to(normal, "z");
    EXPECT_LT(glm::distance(plane.into, -glm::normalize(normal)), 1e-12);
    EXPECT_LT(glm::distance(glm::cross(plane.right, plane.up), -plane.into), 1e-12);
    EXPECT_NEAR(glm::length(plane.up), 1, 1e-12);
  }
  // The plan view.
  EXPECT_LT(glm::distance(plane_square_to({0, 0, 2}, "z").up, glm::dvec3(0, 1, 0)), 1e-12);
  // The front view.
  EXPECT_LT(glm::distance(plane_square_to({0, -1, 0}, "z").right, glm::dvec3(1, 0, 0)), 1e-12);
}

TEST(Plane, OfACameraIsItsOwn) {
  const Plane front = plane_from(Direction::front, "y");
  const Part part = parts_of(some_drawing(front)).front();
  const Plane again = plane_of(part.camera);
  EXPECT_LT(glm::distance(again.right, front.right) + glm::distance(again.up, front.up) +
                glm::distance(again.into, front.into),
            1e-12);
}

TEST(Extent, IsOfWhatTheSectionKeeps) {
  const std::vector<glm::dvec3> points{{0, 0, 0}, {4, 1, 2}, {-1, 5, -3}};
  const Plane plan = plane_from(Direction::top, "z");
  const auto all = extent_of(points, plan, {});
  ASSERT_TRUE(all);
  EXPECT_EQ(all->min, glm::dvec3(-1, 0, -2));  // `into` points down
  EXPECT_EQ(all->max, glm::dvec3(4, 5, 3));
  const std::vector<glm::dvec4> right_half{{1, 0, 0, 0}};
  EXPECT_EQ(extent_of(points, plan, right_half)->min.x, 0);
  const std::vector<glm::dvec4> nothing{{1, 0, 0, -100}};
  EXPECT_FALSE(extent_of(points, plan, nothing));
}

TEST(Scale, IsTheLargestRoundOneThatFits) {
  EXPECT_EQ(fitting_scale({0.1, 0.05}, {200, 200}, 1), 1);  // 100 mm
  EXPECT_EQ(fitting_scale({0.2, 0.05}, {200, 200}, 1), 1);  // fits exactly
  EXPECT_EQ(fitting_scale({0.201, 0.05}, {200, 200}, 1), 2);
  EXPECT_EQ(fitting_scale({0.05, 0.45}, {200, 200}, 1), 2.5);  // 450 mm divided by 2.5
  EXPECT_EQ(fitting_scale({4.9, 1}, {200, 200}, 1), 25);
  EXPECT_EQ(fitting_scale({4.9, 1}, {200, 200}, 0.001), 1);  // unit mm: no enlargement
  EXPECT_EQ(fitting_scale({99000, 1}, {200, 200}, 1), 500'000);
}

TEST(Parts, CoverTheDrawingOnceWithOneScale) {
  for (const Direction direction : {Direction::top, Direction::front, Direction::left}) {
    const Drawing drawing = some_drawing(plane_from(direction, "z"));
    const auto parts = parts_of(drawing);
    ASSERT_GT(parts.size(), 1u);
    std::vector<int> covered(static_cast<std::size_t>(drawing.width) * drawing.height, 0);
    for (const Part& part : parts) {
      EXPECT_TRUE(validate(part.camera));
      EXPECT_TRUE(is_orthographic(part.camera));
      EXPECT_EQ((part.width + 2 * part.margin) * kCameraDpi,
                part.camera.width * drawing.dpi);  // whole pixels per inch
      // Symbols extend this far beyond their points.
      EXPECT_GE(part.margin * kCameraDpi, 8 * drawing.dpi);
      EXPECT_EQ(part.margin % 2, 0);
      for (int y = part.y; y < std::min(drawing.height, part.y + part.height); ++y)
        for (int x = part.x; x < std::min(drawing.width, part.x + part.width); ++x)
          ++covered[static_cast<std::size_t>(y) * drawing.width + x];
    }
    EXPECT_TRUE(std::ranges::all_of(covered, [](int n) { return n == 1; }));
    // The cameras of all parts show a point at the pixel of its position on paper.
    const glm::dvec3 place = drawing.plane.in_world({2.1, -1.4, 3});
    for (const Part& part : parts) {
      const glm::dvec2 pixel = pixel_of(part, place),
                       paper = on_paper(drawing, place) / 25.4 * 300.0;
      EXPECT_LT(glm::distance(pixel, paper), 1e-6) << part.x << " " << part.y;
    }
    // One unit is a centimeter, and 20 mm of the world are 1 mm on paper.
    const glm::dvec2 moved =
        on_paper(drawing, place + 2.0 * drawing.plane.right) - on_paper(drawing, place);
    EXPECT_LT(glm::distance(moved, glm::dvec2(1, 0)), 1e-9);
  }
}

TEST(Parts, JoinAtEveryResolution) {
  for (const int dpi : {50, 72, 96, 97, 150, 600, 1200}) {
    Drawing drawing = some_drawing(plane_from(Direction::front, "z"));
    drawing.dpi = dpi;
    const glm::dvec3 place = drawing.plane.in_world({2.1, -1.4, 3});
    for (const Part& part : parts_of(drawing, 1000)) {
      EXPECT_TRUE(validate(part.camera));
      EXPECT_EQ((part.width + 2 * part.margin) * kCameraDpi, part.camera.width * dpi);
      EXPECT_LT(glm::distance(pixel_of(part, place), on_paper(drawing, place) / 25.4 * (1.0 * dpi)),
                1e-6)
          << dpi;
    }
  }
}

TEST(Parts, OfCoarseDrawingsAreWhole) {
  Drawing drawing = some_drawing(plane_from(Direction::top, "z"));
  drawing.dpi = 50;
  drawing.width = drawing.height = 500;
  const auto parts = parts_of(drawing);
  ASSERT_EQ(parts.size(), 1u);
  EXPECT_EQ(parts[0].width, 40 * 50);
  EXPECT_GE(parts[0].camera.width, 40 * kCameraDpi);
}

}  // namespace
}  // namespace strata::figure
