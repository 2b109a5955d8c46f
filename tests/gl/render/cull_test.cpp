#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <glm/gtc/matrix_transform.hpp>
#include <random>
#include <set>

#include "render/edit/block_culler.h"
#include "render/edit/edit_culler.h"
#include "shared/edit.h"
#include "support/gl_scene.h"
#include "support/shader_dirs.h"

namespace strata::test {
namespace {

constexpr int kResolution = 2048;

// The cullers of the CPU and the GPU for one scene, in the GL context of a renderer.
class Cullers {
 public:
  explicit Cullers(const Scene& scene)
      : scene_(scene), mesh_(*render::MeshBuffers::create(scene.geometry, memory_)) {
    while (!mesh_->upload_slice()) {
    }
    map_ = *render::SurfaceMapTextures::create(scene.map, memory_);
    while (!map_->upload_slice()) {
    }
    layer_ = *render::LayerTextures::create(ValueType::u8, kResolution, tables_, pool_);
  }

  struct Found {
    std::map<std::uint32_t, std::uint32_t> parts;  // parts, with the bits of their segments
    std::set<TileAddress> tiles;
  };
  Found on_gpu(const StrokeBatch& stroke, const render::ToolPath& path) {
    auto depth = draw_depth(depths_, *mesh_, stroke.camera);
    EXPECT_TRUE(depths_.make_grid(*depth));
    auto read = culler_.dispatch(stroke, scene_.geometry->origin, path, bias_of(stroke), *map_,
                                 &depth->grid, *layer_);
    EXPECT_TRUE(read) << read.error().detail;
    while (!read->ready()) {
    }
    const auto touched = render::EditCuller::touched(*read, kResolution);
    std::vector<shader::TouchedPart> listed(touched.parts);
    glGetNamedBufferSubData(map_->touched_parts().id(), 0,
                            static_cast<GLsizeiptr>(listed.size() * sizeof(listed[0])),
                            listed.data());
    Found found;
    for (const auto& part : listed)
      EXPECT_TRUE(found.parts.emplace(part.part, part.segments).second) << "listed twice";
    for (const auto tile : touched.tiles)
      EXPECT_TRUE(found.tiles.insert(tile).second) << "listed twice";
    return found;
  }
  render::TouchedParts on_cpu(const StrokeBatch& stroke, const render::ToolPath& path) {
    auto depth = draw_depth(depths_, *mesh_, stroke.camera);
    render::DepthBuffers::copy_to_memory(*depth, 1);
    const auto& copy = *depth->copy;
    return render::BlockCuller(*scene_.map, clip_from_model(stroke), stroke.camera.width,
                               stroke.camera.height, path, bias_of(stroke),
                               {copy.grid.data(), render::depth_cells(copy.width),
                                render::depth_cells(copy.height)})
        .find(1);
  }

 private:
  glm::dmat4 clip_from_model(const StrokeBatch& stroke) const {
    return stroke.camera.projection * stroke.camera.view *
           glm::translate(glm::dmat4(1), scene_.geometry->origin);
  }
  render::DepthBias bias_of(const StrokeBatch& stroke) const {
    return render::depth_bias_of(
        stroke, glm::length(glm::dvec3(scene_.geometry->box_max - scene_.geometry->box_min)));
  }

  const Scene& scene_;
  render::GpuMemory memory_{std::uint64_t{1} << 30};
  gl::ReadbackPool readback_;
  render::DepthBuffers depths_ =
      *render::DepthBuffers::create(shader_dir(), 1u << 20, memory_, readback_);
  render::EditCuller culler_ = *render::EditCuller::create(shader_dir(), readback_);
  render::PageTables tables_{memory_};
  render::PagePool pool_{1, memory_};
  std::unique_ptr<render::MeshBuffers> mesh_;
  std::unique_ptr<render::SurfaceMapTextures> map_;
  std::unique_ptr<render::LayerTextures> layer_;
};

StrokeBatch random_stroke(std::mt19937& random) {
  const auto in = [&](double low, double high) {
    return std::uniform_real_distribution(low, high)(random);
  };
  const glm::dvec3 eye(in(-2.5, 2.5), in(-2.5, 2.5), in(1.2, 2.6));
  auto stroke = random() % 3 == 0
                    ? dab(orthographic_camera(eye, {0, 0, 0}, 800, 600, in(0.4, 1.4)), 0, 0, 0)
                    : dab(perspective_camera(eye, {0, 0, 0}, 800, 600), 0, 0, 0);
  stroke.path.clear();
  const int most = random() % 4 == 0 ? 100 : 4;
  for (int i = 0, count = std::uniform_int_distribution(1, most)(random); i < count; ++i)
    stroke.path.emplace_back(in(100, 700), in(50, 550));
  stroke.radius_px = in(1, 80);
  if (random() % 3 == 0)
    for (std::size_t i = 0; i < stroke.path.size(); ++i) stroke.widths.push_back(in(0.05, 1));
  if (random() % 3 == 0) stroke.shape = ToolShape::square;
  return stroke;
}

TEST(EditCuller, lists_the_parts_that_the_cpu_lists_and_few_others) {
  TestRenderer renderer;
  const auto scene = make_scene(bumpy_sphere(80), kResolution);
  renderer->run_on_gpu_thread_for_test([&] {
    Cullers cullers(scene);
    std::mt19937 random(11);
    std::size_t on_cpu = 0, on_gpu = 0;
    for (int i = 0; i < 40; ++i) {
      const auto stroke = random_stroke(random);
      const auto path =
          render::make_tool_path(stroke, std::vector<double>(stroke.path.size(), stroke.radius_px));
      const auto found = cullers.on_gpu(stroke, path);
      const auto expected = cullers.on_cpu(stroke, path);
      const std::size_t per_bit = (path.segments.size() + 31) / 32;
      std::set<TileAddress> tiles;
      for (const auto& tile : expected.tiles) {
        for (const auto& part : std::span(expected.parts).subspan(tile.first, tile.count)) {
          // The CPU accepts eight parts together if the tool covers them, without testing each
          // part.
          const auto listed = found.parts.find(part.part);
          if (listed == found.parts.end()) {
            EXPECT_TRUE(part.in_tool);
            continue;
          }
          tiles.insert(tile.address);
          std::uint32_t bits = 0;
          for (const auto segment : expected.segment_lists.at(part.segments, part.segment_count))
            bits |= 1u << (segment / per_bit);
          EXPECT_TRUE((bits & ~listed->second) == 0 || std::has_single_bit(listed->second))
              << "more than one segment, and one that is missing";
        }
      }
      EXPECT_TRUE(std::ranges::includes(found.tiles, tiles));
      on_cpu += expected.parts.size();
      on_gpu += found.parts.size();
    }
    EXPECT_GT(on_cpu, 10'000u);
    EXPECT_LT(static_cast<double>(on_gpu), 1.1 * static_cast<double>(on_cpu));
  });
}

TEST(EditCuller, lists_nothing_for_a_tool_beside_the_model) {
  TestRenderer renderer;
  const auto scene = make_scene(bumpy_sphere(20), kResolution);
  renderer->run_on_gpu_thread_for_test([&] {
    Cullers cullers(scene);
    const auto stroke = dab(perspective_camera({0, 0, 5}, {0, 0, 0}, 800, 600), 20, 20, 10);
    const auto found =
        cullers.on_gpu(stroke, render::make_tool_path(stroke, std::vector<double>{10}));
    EXPECT_TRUE(found.parts.empty());
    EXPECT_TRUE(found.tiles.empty());
  });
}

}  // namespace
}  // namespace strata::test
