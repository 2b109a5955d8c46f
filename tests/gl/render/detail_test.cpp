#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "mesh/surface/detail_levels.h"
#include "render/thread/detail_budget.h"
#include "shared/cluster.h"
#include "support/gl_scene.h"
#include "support/shader_dirs.h"

namespace strata::test {
namespace {

// A sphere with so many triangles that every software renderer simplifies it during a movement.
class Detail : public testing::Test {
 protected:
  Detail() : scene_(make_scene(bumpy_sphere(300), 512)) {
    Progress progress;
    auto levels = mesh::make_detail_levels(*scene_.geometry, progress);
    for (auto& level : *levels)
      scene_.coarser.push_back(std::make_shared<const mesh::Geometry>(std::move(level)));
    model_ = renderer_.add(scene_);
    request_.view = renderer_.add_view(model_);
    request_.camera = perspective_camera({0, -3.5, 0.8}, {0, 0, 0}, 320, 240);
    request_.width = 320;
    request_.height = 240;
  }
  static double mean_difference(const render::Frame& a, const render::Frame& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i)
      sum += std::abs(int(a.pixels[i]) - int(b.pixels[i]));
    return sum / static_cast<double>(a.pixels.size());
  }

  TestRenderer renderer_;
  Scene scene_;
  render::ModelHandle model_ = 0;
  render::FrameRequest request_;
};

TEST_F(Detail, of_a_moving_camera_is_coarser_and_looks_nearly_the_same) {
  if (!renderer_->info().software) GTEST_SKIP() << "a GPU has time for the full mesh";
  request_.moving = true;
  const auto moving = renderer_.draw(request_);
  EXPECT_GT(moving.level, 0);
  request_.moving = false;
  const auto still = renderer_.draw(request_);
  EXPECT_EQ(still.level, 0);
  EXPECT_EQ(still.rects.at(0), (render::PixelRect{0, 0, 320, 240}));
  EXPECT_GT(mean_difference(moving, still), 0) << "the same triangles were drawn";
  EXPECT_LT(mean_difference(moving, still), 2);
}

TEST_F(Detail, of_a_picture_that_is_there_is_not_lowered) {
  const auto still = renderer_.draw(request_);
  request_.moving = true;
  const auto moving = renderer_.draw(request_);
  EXPECT_EQ(moving.level, 0);
  EXPECT_EQ(mean_difference(still, moving), 0);
}

TEST_F(Detail, never_reaches_the_depth_of_an_edit) {
  const auto layer = renderer_.add_layer(model_, ValueType::u8, 512);
  const auto fresh = renderer_.add_layer(model_, ValueType::u8, 512);
  const auto stroke = dab(request_.camera, 160, 120, 60);
  request_.moving = true;
  renderer_.draw(request_);  // leaves a coarse depth of the same camera
  const auto after_moving = renderer_.paint(layer, stroke);
  request_.moving = false;
  renderer_.draw(request_);
  const auto after_still = renderer_.paint(fresh, stroke);
  ASSERT_EQ(after_moving.tiles.size(), after_still.tiles.size());
  ASSERT_FALSE(after_still.tiles.empty());
  for (std::size_t i = 0; i < after_still.tiles.size(); ++i) {
    EXPECT_EQ(after_moving.tiles[i].address, after_still.tiles[i].address);
    EXPECT_TRUE(after_moving.tiles[i].written == after_still.tiles[i].written);
  }
}

TEST_F(Detail, does_not_matter_for_clusters_outside_the_window) {
  // The same mesh with boxes that are never outside the window, so all clusters are drawn.
  auto unculled = std::make_shared<mesh::Geometry>(*scene_.geometry);
  for (auto& box : unculled->clusters) box = {unculled->box_min, unculled->box_max};
  Scene all;
  all.geometry = unculled;
  auto request_all = request_;
  request_all.view = renderer_.add_view(renderer_.add(all));
  const std::array<Camera, 4> cameras{
      perspective_camera({0.2, -1.25, 0.1}, {0.4, 0, 0.2}, 320, 240),
      perspective_camera({0, 0, 0}, {1, 0.3, 0}, 320, 240, 70),
      orthographic_camera({0, -3, 0}, {0.5, 0, 0.3}, 320, 240, 0.2),
      perspective_camera({0.97, -0.1, 0}, {0.97, 1, 0}, 320, 240, 90)};
  for (const Camera& camera : cameras) {
    request_.camera = request_all.camera = camera;
    EXPECT_EQ(mean_difference(renderer_.draw(request_), renderer_.draw(request_all)), 0);
  }
}

// Draws a sphere of 380 clusters completely.
class Hidden : public testing::Test {
 protected:
  // Returns the number of culled draw commands.
  static std::size_t draw(render::MeshPass& pass, const render::MeshBuffers& mesh,
                          const Camera& camera, render::DepthBuffer& buffer) {
    render::MeshProgress progress;
    const auto view = render::mesh_view(camera, mesh.geometry().origin);
    while (true) {
      const auto complete =
          pass.draw_slice(mesh, view, {buffer.framebuffer, buffer.texture}, progress);
      EXPECT_TRUE(complete) << complete.error().detail;
      if (!complete || *complete) break;
    }
    std::vector<shader::DrawCommand> commands(progress.clusters);
    glGetNamedBufferSubData(progress.commands.id(), 0,
                            static_cast<GLsizeiptr>(commands.size() * sizeof(shader::DrawCommand)),
                            commands.data());
    return static_cast<std::size_t>(
        std::ranges::count(commands, 0u, &shader::DrawCommand::instance_count));
  }

  TestRenderer renderer_;
  Scene scene_ = make_scene(bumpy_sphere(180), 512);
};

TEST_F(Hidden, clusters_are_left_out_and_the_picture_stays) {
  // The same mesh with boxes that are never hidden.
  auto unculled = std::make_shared<mesh::Geometry>(*scene_.geometry);
  for (auto& box : unculled->clusters) box = {unculled->box_min, unculled->box_max};
  const Scene all{unculled, scene_.map, {}};
  std::vector<Camera> cameras{perspective_camera({0, -3.5, 0.8}, {0, 0, 0}, 640, 480),
                              perspective_camera({1.1, 0.2, 0.1}, {0, 0, 0}, 333, 217),
                              perspective_camera({0.3, 0, 0}, {1, 0.5, 0}, 320, 240),
                              orthographic_camera({2, 2, 1}, {0, 0, 0}, 500, 400, 1.3)};
  cameras.push_back(cameras.front());
  cameras.back().section = {{0, 1, 0, 0.2}};
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    EXPECT_EQ(renderer_.depth(scene_, cameras[i]), renderer_.depth(all, cameras[i]))
        << "camera " << i;
  }
}

TEST_F(Hidden, clusters_of_the_far_side_are_most_of_it) {
  const Camera camera = perspective_camera({0, -3.5, 0.8}, {0, 0, 0}, 640, 480);
  renderer_->run_on_gpu_thread_for_test([&] {
    render::GpuMemory memory(std::uint64_t{1} << 32);
    gl::ReadbackPool readback;
    auto depths =
        render::DepthBuffers::create(shader_dir(), std::size_t{1} << 16, memory, readback);
    auto buffer = depths->start(render::depth_key(1, camera, camera.width, camera.height));
    auto mesh = render::MeshBuffers::create(scene_.geometry, memory);
    while (!(*mesh)->upload_slice()) {
    }
    // The result must not depend on the size of a slice.
    for (const std::size_t slice : {std::size_t{1} << 13, std::size_t{1} << 30}) {
      auto pass = render::MeshPass::create(render::MeshPass::Kind::depth, shader_dir(), slice);
      ASSERT_TRUE(pass);
      const std::size_t hidden = draw(*pass, **mesh, camera, **buffer);
      EXPECT_GT(hidden, scene_.geometry->clusters.size() / 4) << "slices of " << slice;
      EXPECT_LT(hidden, scene_.geometry->clusters.size() * 6 / 10) << "slices of " << slice;
    }
  });
}

TEST(DetailBudget, takes_the_finest_level_that_fits_and_the_coarsest_when_none_does) {
  render::DetailBudget budget(true);
  const std::array<std::size_t, 3> levels{4'000'000, 1'000'000, 100'000};
  EXPECT_EQ(budget.choose(levels), 2);
  EXPECT_EQ(budget.choose(std::array<std::size_t, 2>{60'000, 20'000}), 0);
  EXPECT_EQ(budget.choose(std::array<std::size_t, 2>{90'000'000, 50'000'000}), 1);
}

TEST(DetailBudget, learns_from_what_drawings_took) {
  render::DetailBudget budget(true);
  const std::array<std::size_t, 2> levels{1'000'000, 100'000};
  ASSERT_EQ(budget.choose(levels), 1);
  for (int i = 0; i < 50; ++i) budget.drawn(1'000'000, 2);
  EXPECT_EQ(budget.choose(levels), 0);
  for (int i = 0; i < 50; ++i) budget.drawn(1'000'000, 60);
  EXPECT_EQ(budget.choose(levels), 1);
  for (int i = 0; i < 50; ++i) budget.drawn(100, 1);  // too few triangles for a decision
  EXPECT_EQ(budget.choose(levels), 1);
}

}  // namespace
}  // namespace strata::test
