// Lines and points over the surface, against distances on the picture's plane.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/gl_scene.h"

namespace strata::test {
namespace {

constexpr int kSize = 200;
constexpr Rgba kRed{220, 30, 20, 255};

class Marks : public testing::Test {
 protected:
  Marks() : scene_(make_scene(flat_square(), 128)), model_(renderer_.add(scene_)) {}

  // The square's corner is 0, 0. Seen from above a pixel is 1/100 of its side.
  static glm::dvec3 at(double x, double y, double z = 0) { return {x - 0.5, y - 0.5, z}; }
  static Camera from_above() { return orthographic_camera({0, 0, 2}, {0, 0, 0}, kSize, kSize, 1); }
  static glm::dvec2 on_picture(double x, double y) { return {(x + 0.5) * 100, kSize - (y + 0.5) * 100}; }

  render::Frame draw(const Camera& camera, std::vector<render::DrawnMark> marks, int scale = 1) {
    render::FrameRequest request;
    request.view = renderer_.add_view(model_);
    request.camera = camera;
    request.width = scale * camera.width, request.height = scale * camera.height;
    if (!marks.empty()) request.marks = std::make_shared<const std::vector<render::DrawnMark>>(std::move(marks));
    auto frame = renderer_.draw(request);
    renderer_->remove_view(request.view);
    return frame;
  }
  static std::array<int, 3> pixel(const render::Frame& frame, int x, int y) {
    const auto* p = &frame.pixels[4 * (static_cast<std::size_t>(y) * frame.width + x)];
    return {p[0], p[1], p[2]};
  }

  // Each pixel is the mark's, its casing's or what was there, but for one pixel at the borders.
  static void expect_mark(const render::Frame& with, const render::Frame& without, glm::dvec2 a, glm::dvec2 b,
                          double width, double scale = 1) {
    const double half = width / 2 * scale, casing = render::kMarkCasing_px * scale;
    int marked = 0;
    for (int y = 0; y < with.height; ++y)
      for (int x = 0; x < with.width; ++x) {
        const glm::dvec2 p(x + 0.5, y + 0.5), along = b - a;
        const double squared = glm::dot(along, along);
        const double t = squared > 0 ? std::clamp(glm::dot(p - a, along) / squared, 0.0, 1.0) : 0;
        const double apart = glm::distance(p, a + t * along);
        if (apart < half - 0.6) {
          ++marked;
          ASSERT_EQ(pixel(with, x, y), (std::array<int, 3>{kRed[0], kRed[1], kRed[2]})) << x << " " << y;
        } else if (apart > half + 0.6 && apart < half + casing - 0.6) {
          ASSERT_EQ(pixel(with, x, y), (std::array<int, 3>{255, 255, 255})) << x << " " << y;
        } else if (apart > half + casing + 0.6) {
          ASSERT_EQ(pixel(with, x, y), pixel(without, x, y)) << x << " " << y;
        }
      }
    EXPECT_GT(marked, 20);
  }

  TestRenderer renderer_;
  Scene scene_;
  render::ModelHandle model_;
};

TEST_F(Marks, lines_are_as_wide_as_they_should_be_with_round_ends_and_a_casing) {
  const auto without = draw(from_above(), {});
  for (const auto& [from, to] : {std::pair{glm::dvec2(0.2, 0.5), glm::dvec2(0.8, 0.5)},
                                 {glm::dvec2(0.3, 0.1), glm::dvec2(0.7, 0.95)},
                                 {glm::dvec2(-0.2, 0.4), glm::dvec2(0.4, 0.4)}}) {
    const auto with = draw(from_above(), {{{at(from.x, from.y), at(to.x, to.y)}, kRed}});
    expect_mark(with, without, on_picture(from.x, from.y), on_picture(to.x, to.y), render::kLineWidth_px);
  }
}

TEST_F(Marks, a_line_of_many_parts_is_one_line) {
  std::vector<glm::dvec3> places;
  for (int i = 0; i <= 40; ++i) places.push_back(at(0.2 + i * 0.6 / 40, 0.5));
  expect_mark(draw(from_above(), {{places, kRed}}), draw(from_above(), {}), on_picture(0.2, 0.5), on_picture(0.8, 0.5),
              render::kLineWidth_px);
}

TEST_F(Marks, points_are_discs_and_pictures_that_are_larger_show_all_larger) {
  expect_mark(draw(from_above(), {{{at(0.4, 0.6)}, kRed}}), draw(from_above(), {}), on_picture(0.4, 0.6),
              on_picture(0.4, 0.6), render::kPointWidth_px);
  expect_mark(draw(from_above(), {{{at(0.4, 0.6)}, kRed}}, 3), draw(from_above(), {}, 3), 3.0 * on_picture(0.4, 0.6),
              3.0 * on_picture(0.4, 0.6), render::kPointWidth_px, 3);
}

TEST_F(Marks, what_the_surface_hides_is_not_seen) {
  const auto without = draw(from_above(), {});
  const auto below = draw(from_above(), {{{at(0.2, 0.5, -0.3), at(0.8, 0.5, -0.3)}, kRed}});
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) ASSERT_EQ(pixel(below, x, y), pixel(without, x, y)) << x << " " << y;
  const auto above = draw(from_above(), {{{at(0.2, 0.5, 0.3), at(0.8, 0.5, 0.3)}, kRed}});
  EXPECT_NE(above.pixels, without.pixels);
}

TEST_F(Marks, the_section_cuts_them) {
  Camera camera = from_above();
  camera.section = {{1, 0, 0, 0}};  // keeps the right half
  const auto with = draw(camera, {{{at(0.2, 0.5), at(0.8, 0.5)}, kRed}, {{at(0.3, 0.8)}, kRed}});
  expect_mark(with, draw(camera, {}), on_picture(0.5, 0.5), on_picture(0.8, 0.5), render::kLineWidth_px);
}

TEST_F(Marks, a_line_past_the_eye_shows_the_part_that_is_ahead) {
  const Camera camera = perspective_camera({0, 0, 2}, {0, 0, 0}, kSize, kSize);
  const auto without = draw(camera, {});
  // From the middle of the square straight up, and past the eye at its side.
  const auto with = draw(camera, {{{at(0.5, 0.5), at(0.9, 0.5, 5)}, kRed}, {{at(0.5, 0.5, 3)}, kRed}});
  EXPECT_EQ(pixel(with, kSize / 2 + 2, kSize / 2), (std::array<int, 3>{kRed[0], kRed[1], kRed[2]}));
  EXPECT_EQ(pixel(with, kSize - 2, kSize / 2), (std::array<int, 3>{kRed[0], kRed[1], kRed[2]}));
  for (int y = 0; y < kSize; ++y) ASSERT_EQ(pixel(with, kSize / 4, y), pixel(without, kSize / 4, y));
}

TEST_F(Marks, a_part_of_a_picture_that_is_drawn_anew_has_them_too) {
  render::FrameRequest request;
  request.view = renderer_.add_view(model_);
  request.camera = from_above();
  request.width = request.height = kSize;
  request.marks = std::make_shared<const std::vector<render::DrawnMark>>(
      std::vector<render::DrawnMark>{{{at(0.1, 0.1), at(0.9, 0.9)}, kRed}});
  const auto whole = renderer_.draw(request);
  request.changed = std::vector<render::FrameRequest::Box>{{{-0.1f, -0.1f, 0}, {0.1f, 0.1f, 0}}};
  const auto part = renderer_.draw(request);
  ASSERT_LT(part.rects.at(0).width, kSize);
  ASSERT_GT(part.rects.at(0).width, 0);
  for (int y = 0; y < part.rects.at(0).height; ++y)
    for (int x = 0; x < part.rects.at(0).width; ++x) {
      const auto* p = &part.pixels[4 * (static_cast<std::size_t>(y) * part.rects.at(0).width + x)];
      ASSERT_EQ((std::array<int, 3>{p[0], p[1], p[2]}), pixel(whole, part.rects.at(0).x + x, part.rects.at(0).y + y));
    }
  // Other marks: all of the picture, though nothing of the surface changed.
  request.marks = nullptr;
  request.changed = std::vector<render::FrameRequest::Box>{};
  EXPECT_EQ(renderer_.draw(request).rects.at(0).width, kSize);
  renderer_->remove_view(request.view);
}

}  // namespace
}  // namespace strata::test
