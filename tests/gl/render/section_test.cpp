#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "support/edit_oracle.h"

namespace strata::test {
namespace {

constexpr int kResolution = 1024, kSize = 400;
constexpr double kMiddle = kSize / 2.0;
constexpr int kUndecidedOneIn = 5'000;  // the planes are an additional threshold
constexpr std::array<int, 3> kInside{219, 209, 194}, kInk{61, 48, 41};  // shaders/shared/cut.h

// Returns a ball of radius 1 with a cavity of radius 0.7. The outer surface uses the left half of
// the atlas.
mesh::TriangleMesh hollow_ball() {
  auto ball = bumpy_sphere(40);
  const auto outer = ball;
  const auto first = static_cast<std::uint32_t>(ball.positions.size());
  for (const auto& position : outer.positions) ball.positions.push_back(0.7 * position);
  for (std::size_t i = 0; i < outer.triangles.size(); i += 3)
    for (const std::size_t corner : {0, 2, 1}) {
      ball.triangles.push_back(first + outer.triangles[i + corner]);
      ball.corner_uvs.push_back(outer.corner_uvs[i + corner]);
    }
  for (std::size_t i = 0; i < ball.corner_uvs.size(); ++i)
    ball.corner_uvs[i].x = ball.corner_uvs[i].x / 2 + (i < outer.corner_uvs.size() ? 0.0f : 0.5f);
  return ball;
}

int count(const render::StrokeOutcome& outcome, bool outer) {
  int count = 0;
  for (const auto& tile : outcome.tiles)
    if ((tile.address.x < kResolution / kTileSize / 2) == outer) count += tile.written.count();
  return count;
}

// Returns whether a color belongs to the inside of a cut solid: the ground color, the ink color or
// a mixture of both.
bool is_inside(const std::array<int, 3>& color) {
  const double ink = double(kInside[0] - color[0]) / (kInside[0] - kInk[0]);
  for (std::size_t i = 0; i < 3; ++i)
    if (std::abs(kInside[i] + ink * (kInk[i] - kInside[i]) - color[i]) > 3) return false;
  return ink > -0.02 && ink < 1.02;
}

class Section : public testing::Test {
 protected:
  Section() : scene_(make_scene(hollow_ball(), kResolution)), model_(renderer_.add(scene_)) {
    camera_ = orthographic_camera({4, 0, 0}, {0, 0, 0}, kSize, kSize, 1.25);
    camera_.section = {{-2, 0, 0, 0}};  // keeps x below 0: the half on the far side
  }
  std::array<int, 3> pixel(const Camera& camera, int x, int y) {
    render::FrameRequest request;
    request.view = renderer_.add_view(model_);
    request.camera = camera;
    request.width = camera.width, request.height = camera.height;
    const auto frame = renderer_.draw(request);
    renderer_->remove_view(request.view);
    const auto* p = &frame.pixels[4 * static_cast<std::size_t>(y * frame.width + x)];
    return {p[0], p[1], p[2]};
  }
  // Returns the pixel at a radius to the right of the center. The cut wall of the ball is between
  // the radii 0.7 and 1.
  static int at_radius(double radius) { return static_cast<int>(kMiddle * (1 + radius / 1.25)); }
  render::StrokeOutcome paint(const StrokeBatch& stroke) {
    return renderer_.paint(renderer_.add_layer(model_, ValueType::u8, kResolution), stroke);
  }

  TestRenderer renderer_;
  Scene scene_;
  render::ModelHandle model_;
  Camera camera_;
};

TEST_F(Section, a_cut_ball_shows_its_hollow_and_a_closed_wall) {
  const int middle = kSize / 2;
  EXPECT_TRUE(is_inside(pixel(camera_, at_radius(0.85), middle)));
  EXPECT_TRUE(is_inside(pixel(camera_, middle, kSize - at_radius(0.85))));
  EXPECT_FALSE(is_inside(pixel(camera_, middle, middle))) << "the hollow is surface";
  Camera whole = camera_;
  whole.section.clear();
  EXPECT_FALSE(is_inside(pixel(whole, at_radius(0.85), middle)));
  Camera nothing = camera_;
  nothing.section = {{1, 0, 0, -5}};
  EXPECT_EQ(pixel(nothing, middle, middle), pixel(camera_, 2, middle)) << "all is cut away";
}

TEST_F(Section, the_cut_is_hatched_at_45_degrees_and_has_an_outline) {
  render::FrameRequest request;
  request.view = renderer_.add_view(model_);
  request.camera = camera_;
  request.width = request.height = kSize;
  const auto frame = renderer_.draw(request);
  const auto at = [&](int x, int y) {
    const auto* p = &frame.pixels[4 * static_cast<std::size_t>(y * kSize + x)];
    return std::array<int, 3>{p[0], p[1], p[2]};
  };
  // The oracle: lines that are 9 pixels apart and 1.25 pixels wide, from the center of the model's
  // box.
  const mesh::Geometry& geometry = *scene_.geometry;
  const glm::dvec3 center = geometry.origin + glm::dvec3(geometry.box_min + geometry.box_max) * 0.5;
  const glm::dvec4 origin = camera_.projection * camera_.view * glm::dvec4(center, 1);
  const auto hatch = [&](int x, int y) {
    const double right = x + 0.5 - kSize / 2.0 * (1 + origin.x),
                 up = kSize / 2.0 * (1 - origin.y) - y - 0.5;
    const double across = (right - up) * std::sqrt(0.5) / 9;
    const double middle = std::abs(across - std::floor(across) - 0.5) * 9;
    return std::clamp(0.5 * 1.25 - middle + 0.5, 0.0, 1.0);
  };
  int lines = 0, inside = 0;
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      const double radius = std::hypot(x + 0.5 - kSize / 2.0, y + 0.5 - kSize / 2.0) / kSize * 2.5;
      if (radius < 0.75 || radius > 0.95) continue;
      ++inside;
      if (hatch(x, y) > 0.5) ++lines;
      for (std::size_t i = 0; i < 3; ++i)
        ASSERT_NEAR(at(x, y)[i], kInside[i] + hatch(x, y) * (kInk[i] - kInside[i]), 2.0)
            << x << " " << y;
    }
  EXPECT_GT(inside, 20'000);
  EXPECT_NEAR(double(lines) / inside, 1.25 / 9, 0.03);
  // From the middle to the right, the cut begins and ends with a pixel of ink.
  int begin = at_radius(0.6), end = at_radius(1.1);
  while (!is_inside(at(begin, kSize / 2))) ++begin;
  while (!is_inside(at(end, kSize / 2))) --end;
  for (const int x : {begin, begin + 1, end - 1, end}) EXPECT_EQ(at(x, kSize / 2), kInk) << x;
  EXPECT_NEAR(begin, at_radius(0.7), 4);
  EXPECT_NEAR(end, at_radius(1), 4);
}

TEST_F(Section, the_wall_is_closed_for_perspective_and_mirrored_cameras) {
  Camera camera =
      perspective_camera({4, 0, 0}, {0, 0, 0}, kSize, kSize, 2 * 57.29578 * std::atan(1.25 / 4));
  camera.section = camera_.section;
  EXPECT_TRUE(is_inside(pixel(camera, at_radius(0.85), kSize / 2)));
  Camera mirrored = camera_;
  mirrored.view = glm::scale(glm::dmat4(1), {-1, 1, 1}) * mirrored.view;
  EXPECT_TRUE(is_inside(pixel(mirrored, at_radius(0.85), kSize / 2)));
  EXPECT_FALSE(is_inside(pixel(mirrored, kSize / 2, kSize / 2)));
}

TEST_F(Section, from_the_side_that_is_kept_nothing_is_closed) {
  Camera camera = orthographic_camera({-4, 0, 0}, {0, 0, 0}, kSize, kSize, 1.25);
  const auto before = pixel(camera, at_radius(0.85), kSize / 2);
  camera.section = camera_.section;
  EXPECT_EQ(pixel(camera, at_radius(0.85), kSize / 2), before);
}

TEST_F(Section, a_box_of_six_planes_keeps_what_is_inside) {
  camera_.section = {{1, 0, 0, 2},    {-1, 0, 0, 0.5}, {0, 1, 0, 0.5},
                     {0, -1, 0, 0.5}, {0, 0, 1, 2},    {0, 0, -1, 2}};
  const int middle = kSize / 2;
  EXPECT_EQ(pixel(camera_, middle + 2, at_radius(0.6)), pixel(camera_, 2, at_radius(0.6)))
      << "above the box";
  EXPECT_TRUE(is_inside(pixel(camera_, at_radius(0.7), middle)))
      << "the wall at the near side of the box";
}

TEST_F(Section, a_dab_through_the_opening_paints_the_inside_as_the_oracle_says) {
  const auto stroke = dab(camera_, kMiddle, kMiddle, 50);
  expect_as_oracle(renderer_, scene_, stroke, {500, kUndecidedOneIn}, model_);
  const auto outcome = paint(stroke);
  EXPECT_EQ(count(outcome, true), 0) << "the outer surface is cut away or hidden";
  StrokeBatch uncut = stroke;
  uncut.camera.section.clear();
  EXPECT_EQ(count(paint(uncut), false), 0) << "without the section the outer surface is painted";
}

TEST_F(Section, the_cut_itself_takes_no_paint) {
  EXPECT_EQ(count(paint(dab(camera_, at_radius(0.85), kMiddle, 6)), true), 0);
  EXPECT_EQ(count(paint(dab(camera_, at_radius(0.85), kMiddle, 6)), false), 0);
}

TEST_F(Section, painting_through_stops_at_the_planes) {
  StrokeBatch stroke = dab(camera_, kMiddle, kMiddle, 500);
  stroke.through = true;
  expect_as_oracle(renderer_, scene_, stroke, {10'000, kUndecidedOneIn}, model_);
  const auto outcome = paint(stroke);
  EXPECT_GT(count(outcome, true), 5'000);
  for (std::uint32_t slot = 0; slot < scene_.map->block_of_slot.size(); ++slot) {
    const int block = static_cast<int>(scene_.map->block_of_slot[slot]);
    const int x = block % scene_.map->blocks_per_side, y = block / scene_.map->blocks_per_side;
    for (const auto& tile : outcome.tiles) {
      if (tile.address.x != x / 16 || tile.address.y != y / 16) continue;
      for (int i = 0; i < 64; ++i) {
        const bool written =
            tile.written.test((y % 16 * 8 + i / 8) * kTileSize + x % 16 * 8 + i % 8);
        EXPECT_TRUE(!written || scene_.map->position(slot, i).x <= 1e-5f);
      }
    }
  }
}

TEST_F(Section, an_edit_does_not_use_the_depth_of_another_section) {
  (void)pixel(camera_, 0, 0);  // leaves the depth of the cut ball in the renderer
  StrokeBatch uncut = dab(camera_, kMiddle, kMiddle, 20);
  uncut.camera.section.clear();
  expect_as_oracle(renderer_, scene_, uncut, {100, kUndecidedOneIn}, model_);
  expect_as_oracle(renderer_, scene_, dab(camera_, kMiddle, kMiddle, 20), {100, kUndecidedOneIn},
                   model_);
}

TEST_F(Section, a_view_is_drawn_anew_when_only_its_section_changes) {
  render::FrameRequest request;
  request.view = renderer_.add_view(model_);
  request.camera = camera_;
  request.width = request.height = kSize;
  const auto cut = renderer_.draw(request).pixels;
  request.camera.section.clear();
  const auto whole = renderer_.draw(request).pixels;
  EXPECT_NE(cut, whole);
  request.camera.section = camera_.section;
  EXPECT_EQ(renderer_.draw(request).pixels, cut);
}

}  // namespace
}  // namespace strata::test
