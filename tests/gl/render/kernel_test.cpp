#include <gtest/gtest.h>

#include <cstdio>
#include <map>
#include <random>

#include "support/gl_scene.h"
#include "support/shapes.h"

namespace strata::test {
namespace {

TestRenderer renderer_on(render::EditPath path) {
  render::RendererOptions options;
  options.edit_path = path;
  return TestRenderer(options);
}

std::map<TileAddress, TileMask> written_by(const render::StrokeOutcome& outcome) {
  std::map<TileAddress, TileMask> written;
  for (const auto& tile : outcome.tiles) written[tile.address] = tile.written;
  return written;
}

StrokeBatch random_stroke(std::mt19937& random) {
  const auto in = [&](double low, double high) {
    return std::uniform_real_distribution(low, high)(random);
  };
  const glm::dvec3 eye(in(-2.5, 2.5), in(-2.5, 2.5), in(1.6, 2.6));
  auto stroke = random() % 3 == 0
                    ? dab(orthographic_camera(eye, {0, 0, 0}, 800, 600, in(0.4, 1.4)), 0, 0, 0)
                    : dab(perspective_camera(eye, {0, 0, 0}, 800, 600), 0, 0, 0);
  stroke.path.clear();
  for (std::size_t i = 0; i < 1 + random() % 4; ++i)
    stroke.path.emplace_back(in(150, 650), in(100, 500));
  (random() % 2 ? stroke.radius_px : stroke.radius_world) =
      random() % 2 ? in(0.02, 0.2) : in(0.2, 0.6);
  if (stroke.radius_px > 0) stroke.radius_px *= 300;
  if (random() % 3 == 0)
    for (std::size_t i = 0; i < stroke.path.size(); ++i) stroke.widths.push_back(in(0.05, 1));
  stroke.shape = static_cast<ToolShape>(random() % 3);
  if (stroke.shape == ToolShape::texture) stroke.texture = shape(random() % 2 ? in_flag : in_dots);
  stroke.through = random() % 5 == 0;
  if (!stroke.through && random() % 3 == 0) stroke.max_angle_deg = in(20, 90);
  if (random() % 4 == 0) stroke.fixed_depth_bias = in(0, 0.01);
  if (random() % 3 == 0)
    stroke.camera.section = {{in(-1, 1), in(-1, 1), -1, in(0, 0.5)}, {in(-1, 1), 1, 0, 0.5}};
  return stroke;
}

TEST(Kernel, writes_the_texels_that_the_compute_pass_writes) {
  auto kernel = renderer_on(render::EditPath::kernel),
       compute = renderer_on(render::EditPath::compute);
  EXPECT_EQ(kernel->info().edit_path, render::EditPath::kernel);
  EXPECT_EQ(compute->info().edit_path, render::EditPath::compute);
  const auto scene = make_scene(bumpy_sphere(60), 1024);
  const auto on_kernel = kernel.add(scene), on_compute = compute.add(scene);
  std::mt19937 random(7);
  long written = 0, differ = 0;
  for (int i = 0; i < 40; ++i) {
    const auto stroke = random_stroke(random);
    const auto a = kernel.paint(kernel.add_layer(on_kernel, ValueType::u8, 1024), stroke);
    const auto b = compute.paint(compute.add_layer(on_compute, ValueType::u8, 1024), stroke);
    auto mine = written_by(a), theirs = written_by(b);
    for (const auto& [tile, mask] : theirs) mine.try_emplace(tile);
    for (const auto& [tile, mask] : mine) {
      for (std::size_t word = 0; word < mask.words.size(); ++word) {
        written += std::popcount(mask.words[word] | theirs[tile].words[word]);
        differ += std::popcount(mask.words[word] ^ theirs[tile].words[word]);
      }
    }
  }
  std::printf("kernel and compute: %ld texels written, %ld differ\n", written, differ);
  EXPECT_GT(written, 400'000);
  EXPECT_LE(differ * 20'000, written)
      << "each within rounding of a threshold; the oracle's tests hold either to that";
}

TEST(Kernel, a_stroke_for_whose_tiles_there_is_no_memory_has_painted_nothing) {
  render::RendererOptions options;
  options.edit_path = render::EditPath::kernel;
  options.gpu_memory_bytes = 26u << 20;  // one slice of 256 four-byte pages takes 20 MiB
  TestRenderer renderer(options);
  const auto scene = make_scene(flat_square(), 1024);
  const auto model = renderer.add(scene);
  const auto full = renderer.add_layer(model, ValueType::u32, 2048);
  std::vector<render::TileUpload> tiles;
  const auto tile = std::make_shared<TileData>(ValueType::u32);
  tile->write(0, 1);
  for (std::uint16_t i = 0; i < 250; ++i)
    tiles.push_back({{std::uint16_t(i % 16), std::uint16_t(i / 16)}, tile});
  renderer.write(full, tiles);

  const auto layer = renderer.add_layer(model, ValueType::u32, 1024);
  const auto empty = renderer->layer_bytes_used(layer);
  const auto camera = orthographic_camera({0, 0, 2}, {0, 0, 0}, 200, 200, 0.5);
  const auto refused = await<render::StrokeOutcome>(
      [&](auto done) { renderer->paint(layer, dab(camera, 100, 100, 90, 7), std::move(done)); });
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().code, ErrorCode::out_of_memory);
  EXPECT_EQ(renderer->layer_bytes_used(layer), empty);
  // The six remaining pages must not contain texels of the refused stroke.
  const auto outcome = renderer.paint(layer, dab(camera, 100, 100, 10, 9));
  ASSERT_FALSE(outcome.tiles.empty());
  for (const auto& painted : outcome.tiles) EXPECT_TRUE(painted.after.valid == painted.written);
}

TEST(Kernel, needs_no_surface_map_on_the_gpu) {
  auto kernel = renderer_on(render::EditPath::kernel);
  auto scene = make_scene(flat_square(), 1024);
  const auto map = std::exchange(scene.map, nullptr);
  const auto model = kernel.add(scene);
  const auto before = kernel->gpu_bytes_used();
  ASSERT_TRUE(
      await<void>([&](auto done) { kernel->add_surface_map(model, map, std::move(done)); }));
  EXPECT_EQ(kernel->gpu_bytes_used(), before);
}

}  // namespace
}  // namespace strata::test
