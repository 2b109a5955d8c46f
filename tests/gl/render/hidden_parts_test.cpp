#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "support/edit_oracle.h"

namespace strata::test {
namespace {

constexpr int kResolution = 1024, kSize = 400;
constexpr double kMiddle = kSize / 2.0;

// Returns a ball of radius 1 around a ball of radius 0.7. The outer ball is part 0 and uses the
// left half of the atlas. Without `outer`, the inner ball is the whole mesh.
mesh::TriangleMesh two_balls(bool outer) {
  mesh::TriangleMesh ball = bumpy_sphere(20);
  for (auto& uv : ball.corner_uvs) uv.x /= 2;
  mesh::TriangleMesh inner = ball;
  for (auto& position : inner.positions) position *= 0.7;
  for (auto& uv : inner.corner_uvs) uv.x += 0.5f;
  if (!outer) return inner;
  const auto first = static_cast<std::uint32_t>(ball.positions.size());
  ball.part_ends = {static_cast<std::uint32_t>(ball.triangle_count()),
                    static_cast<std::uint32_t>(2 * ball.triangle_count())};
  ball.positions.insert(ball.positions.end(), inner.positions.begin(), inner.positions.end());
  for (const auto index : inner.triangles) ball.triangles.push_back(first + index);
  ball.corner_uvs.insert(ball.corner_uvs.end(), inner.corner_uvs.begin(), inner.corner_uvs.end());
  return ball;
}

PartSet part(std::size_t number) { return PartSet().set(number); }

class HiddenParts : public testing::Test {
 protected:
  HiddenParts() : scene_(make_scene(two_balls(true), kResolution)), model_(renderer_.add(scene_)) {
    camera_ = perspective_camera({4, 0, 0}, {0, 0, 0}, kSize, kSize, 40);
  }
  render::Frame draw(render::ModelHandle model, const Camera& camera) {
    render::FrameRequest request;
    request.view = renderer_.add_view(model);
    request.camera = camera;
    request.width = camera.width, request.height = camera.height;
    auto frame = renderer_.draw(request);
    renderer_->remove_view(request.view);
    return frame;
  }
  // Returns the number of pixels with clearly different colors.
  static int different(const render::Frame& a, const render::Frame& b) {
    int count = 0;
    for (std::size_t i = 0; i < a.pixels.size(); i += 4) {
      int most = 0;
      for (std::size_t k = 0; k < 3; ++k)
        most = std::max(most, std::abs(a.pixels[i + k] - b.pixels[i + k]));
      count += most > 4 ? 1 : 0;
    }
    return count;
  }
  Camera hiding(std::size_t number) const {
    Camera camera = camera_;
    camera.hidden_parts = part(number);
    return camera;
  }
  int count(const StrokeBatch& stroke, bool outer) {
    const auto outcome =
        renderer_.paint(renderer_.add_layer(model_, ValueType::u8, kResolution), stroke);
    int count = 0;
    for (const auto& tile : outcome.tiles)
      if ((tile.address.x < kResolution / kTileSize / 2) == outer) count += tile.written.count();
    return count;
  }

  TestRenderer renderer_;
  Scene scene_;
  render::ModelHandle model_;
  Camera camera_;
};

TEST_F(HiddenParts, the_triangles_of_a_part_begin_within_a_cluster) {
  ASSERT_EQ(scene_.geometry->part_ends.size(), 2u);
  EXPECT_NE(scene_.geometry->part_ends[0] % mesh::Geometry::kTrianglesPerCluster, 0u);
}

TEST_F(HiddenParts, a_picture_is_that_of_a_model_without_them) {
  const auto inner = renderer_.add(make_scene(two_balls(false), kResolution));
  const auto alone = draw(inner, camera_);
  const auto shown = draw(model_, hiding(0));
  // The origins of both models differ, so coordinates are rounded differently.
  EXPECT_LT(different(shown, alone), kSize * kSize / 1000);
  EXPECT_GT(different(draw(model_, camera_), alone), kSize * kSize / 10);
  EXPECT_EQ(draw(model_, hiding(1)).pixels, draw(model_, camera_).pixels)
      << "the inner ball is hidden by the outer one in any case";
}

TEST_F(HiddenParts, with_all_parts_hidden_the_picture_shows_the_background) {
  Camera camera = hiding(0);
  camera.hidden_parts.set(1);
  Camera away = camera_;
  away.section = {{1, 0, 0, -5}};
  EXPECT_EQ(draw(model_, camera).pixels, draw(model_, away).pixels);
}

TEST_F(HiddenParts, numbers_that_no_part_has_are_ignored) {
  EXPECT_EQ(draw(model_, hiding(200)).pixels, draw(model_, camera_).pixels);
}

TEST_F(HiddenParts, a_view_is_drawn_anew_when_only_they_change) {
  render::FrameRequest request;
  request.view = renderer_.add_view(model_);
  request.width = request.height = kSize;
  request.camera = hiding(0);
  const auto inner = renderer_.draw(request).pixels;
  request.camera = camera_;
  EXPECT_NE(renderer_.draw(request).pixels, inner);
  request.camera = hiding(0);
  EXPECT_EQ(renderer_.draw(request).pixels, inner);
}

TEST_F(HiddenParts, a_dab_paints_the_surface_behind_them_as_the_oracle_says) {
  const auto stroke = dab(hiding(0), kMiddle, kMiddle, 50);
  expect_as_oracle(renderer_, scene_, stroke, {500, 10'000}, model_);
  EXPECT_EQ(count(stroke, true), 0) << "the outer ball is hidden, although it is nearer";
  EXPECT_GT(count(stroke, false), 500);
  EXPECT_EQ(count(dab(camera_, kMiddle, kMiddle, 50), false), 0);
}

TEST_F(HiddenParts, painting_through_leaves_them_out) {
  StrokeBatch stroke = dab(hiding(1), kMiddle, kMiddle, 500);
  stroke.through = true;
  EXPECT_GT(count(stroke, true), 10'000);
  EXPECT_EQ(count(stroke, false), 0);
}

TEST_F(HiddenParts, an_edit_does_not_use_the_depth_of_other_ones) {
  (void)draw(model_, hiding(0));  // leaves the depth of the inner ball in the renderer
  EXPECT_GT(count(dab(camera_, kMiddle, kMiddle, 20), true), 100);
  EXPECT_EQ(count(dab(hiding(0), kMiddle, kMiddle, 20), true), 0);
}

TEST_F(HiddenParts, their_lines_and_points_are_not_drawn) {
  const auto features = std::make_shared<const std::vector<render::DrawnFeature>>(
      std::vector<render::DrawnFeature>{{{{1.5, 0, 0}}, {255, 0, 0, 255}, 1}});
  render::FrameRequest request;
  request.view = renderer_.add_view(model_);
  request.width = request.height = kSize;
  request.style.features = features;
  request.camera = hiding(0);
  const auto with = renderer_.draw(request).pixels;
  EXPECT_NE(with, draw(model_, hiding(0)).pixels) << "a point in front of both balls";
  request.camera = hiding(1);
  EXPECT_EQ(renderer_.draw(request).pixels, draw(model_, hiding(1)).pixels);
}

}  // namespace
}  // namespace strata::test
