#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <random>

#include "bench/peers/paper.h"
#include "mesh/io/load.h"
#include "render/edit/depth_bias.h"
#include "strata_dirs.h"
#include "support/gl_scene.h"
#include "support/shader_dirs.h"

namespace strata::test {
namespace {

constexpr int kResolution = 2048;
constexpr int kEdits = 24;

// Loads a real scan with an atlas made by Strata.
std::optional<Scene> load_scan(const std::string& name) {
  const std::filesystem::path file = std::filesystem::path(STRATA_TEST_DATA) / name;
  if (!std::filesystem::exists(file)) return std::nullopt;
  Progress progress;
  auto loaded = mesh::load_mesh(file, name, progress);
  if (!loaded) throw std::runtime_error(loaded.error().detail);
  auto atlas = mesh::make_atlas(loaded->mesh, kResolution, progress);
  if (!atlas) throw std::runtime_error(atlas.error().detail);
  Scene scene;
  scene.geometry =
      std::make_shared<const mesh::Geometry>(mesh::build_geometry(loaded->mesh, *atlas));
  auto map = mesh::bake_surface_map(*scene.geometry, kResolution, progress);
  if (!map) throw std::runtime_error(map.error().detail);
  scene.map = std::make_shared<const mesh::SurfaceMap>(std::move(*map));
  return scene;
}

// Returns a camera around the model. The paper's bias is fixed in window depth, so its effect
// depends on the near and far planes. These planes have the values of a viewer that does not
// adapt them to the model. With these planes, a bias of 2e-4 is about 0.7 % of the model's radius.
Camera random_camera(const mesh::Geometry& geometry, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  const glm::dvec3 center = geometry.origin + glm::dvec3(geometry.box_min + geometry.box_max) * 0.5;
  const double radius = glm::length(glm::dvec3(geometry.box_max - geometry.box_min)) / 2;
  glm::dvec3 direction;
  do direction = {uniform(random), uniform(random), uniform(random)};
  while (glm::length(direction) < 0.2 || glm::length(direction) > 1);
  const double distance = radius * (2.2 + uniform(random) * 0.6);
  auto camera =
      perspective_camera(center + glm::normalize(direction) * distance, center, 1280, 720);
  const double near = distance / 27, far = distance * 3.7;
  camera.projection[2][2] = -(far + near) / (far - near);
  camera.projection[3][2] = -2 * far * near / (far - near);
  return camera;
}

struct Count {
  long edited = 0, surface_differs = 0, beyond_rounding = 0, gutter = 0, gutter_differs = 0;
};

struct Dab {
  Camera camera;
  double x, y, radius;
};

// Returns whether the rounding of floats and packed positions can change the result for a texel.
// Such a texel is near the tool's edge, near a pixel's border (which selects the depth), or near
// the threshold of the depth test.
bool within_rounding(const Scene& scene, const Dab& dab, const std::vector<float>& depth,
                     const glm::vec3& position) {
  const Camera& camera = dab.camera;
  const glm::dvec4 clip = camera.projection * camera.view *
                          glm::dvec4(glm::dvec3(position) + scene.geometry->origin, 1);
  const glm::dvec3 ndc = glm::dvec3(clip) / clip.w;
  const glm::dvec2 window = (glm::dvec2(ndc) * 0.5 + 0.5) * glm::dvec2(camera.width, camera.height);
  const double edge = dab.radius - glm::length(window - glm::dvec2(dab.x, camera.height - dab.y));
  const glm::dvec2 to_border = glm::abs(window - glm::round(window));
  const double here =
      depth[static_cast<std::size_t>(window.y) * static_cast<std::size_t>(camera.width) +
            static_cast<std::size_t>(window.x)];
  const double behind = ndc.z * 0.5 + 0.5 - bench::kPaperDepthBias - here;
  return std::abs(edge) < 2e-3 || std::min(to_border.x, to_border.y) < 1e-3 ||
         std::abs(behind) < 1e-6;
}

void count(const Scene& scene, const Dab& dab, const std::vector<float>& depth,
           const std::vector<std::uint8_t>& paper, const std::vector<std::uint8_t>& coverage,
           const render::StrokeOutcome& ours, Count& counts) {
  std::vector<std::uint8_t> written(paper.size());
  for (const auto& tile : ours.tiles) {
    for (int i = 0; i < kTexelsPerTile; ++i) {
      if (!tile.written.test(i)) continue;
      const auto x = static_cast<std::size_t>(tile.address.x * kTileSize + i % kTileSize);
      const auto y = static_cast<std::size_t>(tile.address.y * kTileSize + i / kTileSize);
      written[y * kResolution + x] = 1;
    }
  }
  const auto& map = *scene.map;
  for (std::size_t i = 0; i < paper.size(); ++i) {
    if (!paper[i] && !written[i]) continue;
    const std::size_t x = i % kResolution, y = i / kResolution;
    const auto slot =
        map.slot_of_block[y / 8 * static_cast<std::size_t>(map.blocks_per_side) + x / 8];
    const bool surface =
        slot != mesh::kNoSlot && (map.surface_mask[slot] >> (y % 8 * 8 + x % 8) & 1);
    // The paper treats texels that its raster does not cover as padding, although a thin triangle
    // may own them in tiles.
    if (surface && coverage[i]) {
      ++counts.edited;
      if ((paper[i] != 0) == (written[i] != 0)) continue;
      ++counts.surface_differs;
      const auto position = map.position(slot, static_cast<int>(y % 8 * 8 + x % 8));
      counts.beyond_rounding += within_rounding(scene, dab, depth, position) ? 0 : 1;
    } else {
      ++counts.gutter;
      counts.gutter_differs += (paper[i] != 0) != (written[i] != 0) ? 1 : 0;
    }
  }
}

TEST(Paper, padding_by_a_compute_pass_sets_the_texels_that_the_raster_pass_sets) {
  const auto scene = make_scene(bumpy_sphere(40), 1024);
  TestRenderer renderer;
  renderer->run_on_gpu_thread_for_test([&] {
    render::GpuMemory memory(std::uint64_t{1} << 32);
    gl::ReadbackPool readback;
    auto depths = std::move(
        *render::DepthBuffers::create(shader_dir(), std::size_t{1} << 20, memory, readback));
    auto mesh = std::move(*render::MeshBuffers::create(scene.geometry, memory));
    while (!mesh->upload_slice()) {
    }
    const auto camera = perspective_camera({2.0, 2.0, 2.0}, {0, 0, 0}, 1280, 720);
    const auto depth = draw_depth(depths, *mesh, camera);
    auto paper = std::move(*bench::PaperEditor::create(*scene.geometry, 1024));
    const auto masks_of = [&](bench::PaperEditor::Padding padding) {
      paper->clear();
      paper->edit(camera, depth->texture, {640, 360}, 120, 200, padding);
      return std::pair{paper->data(), paper->mask()};
    };
    const auto raster = masks_of(bench::PaperEditor::Padding::raster);
    const auto coverage = paper->coverage();
    std::size_t padded = 0;
    for (std::size_t i = 0; i < coverage.size(); ++i)
      padded += raster.second[i] && !coverage[i] ? 1 : 0;
    EXPECT_GT(padded, 50u) << "the dab must lie over seams";
    EXPECT_TRUE(masks_of(bench::PaperEditor::Padding::compute) == raster);
  });
}

TEST(Paper, surface_texels_are_those_of_the_papers_algorithms_on_random_cameras_and_radii) {
  const auto scene = load_scan("statue_nefertiti_70k.ply");
  if (!scene)
    GTEST_SKIP() << "NO SCANS at " << STRATA_TEST_DATA
                 << ": our edit was not compared with the paper's";
  TestRenderer renderer;
  const auto model = renderer.add(*scene);
  std::unique_ptr<bench::PaperEditor> paper;
  renderer->run_on_gpu_thread_for_test(
      [&] { paper = std::move(*bench::PaperEditor::create(*scene->geometry, kResolution)); });

  std::mt19937 random(20260101);
  Count counts;
  for (int edit = 0; edit < kEdits; ++edit) {
    const auto camera = random_camera(*scene->geometry, random);
    const double x = std::uniform_real_distribution(480.0, 800.0)(random),
                 y = std::uniform_real_distribution(200.0, 520.0)(random);
    const double radius = std::uniform_real_distribution(5.0, 150.0)(random);
    const auto layer = renderer.add_layer(model, ValueType::u8, kResolution);
    auto stroke = dab(camera, x, y, radius, 200);
    stroke.fixed_depth_bias = bench::kPaperDepthBias;
    const auto ours = renderer.paint(layer, stroke);
    renderer->remove_layer(layer);
    std::vector<std::uint8_t> mask, coverage;
    renderer->run_on_gpu_thread_for_test([&] {
      render::GpuMemory memory(std::uint64_t{1} << 32);
      gl::ReadbackPool readback;
      auto depths = std::move(
          *render::DepthBuffers::create(shader_dir(), std::size_t{1} << 20, memory, readback));
      auto mesh = std::move(*render::MeshBuffers::create(scene->geometry, memory));
      while (!mesh->upload_slice()) {
      }
      const auto depth = draw_depth(depths, *mesh, camera);
      paper->clear();
      paper->edit(camera, depth->texture, {x, y}, radius, 200);
      mask = paper->mask();
      coverage = paper->coverage();
    });
    count(*scene, {camera, x, y, radius}, renderer.depth(*scene, camera), mask, coverage, ours,
          counts);
  }
  renderer->run_on_gpu_thread_for_test([&] { paper.reset(); });
  std::printf(
      "paper: %ld surface texels edited, %ld differ; %ld gutter texels, %ld differ (ours is 2 wide and knows islands)\n",
      counts.edited, counts.surface_differs, counts.gutter, counts.gutter_differs);
  EXPECT_GT(counts.edited, 300'000);
  // The remaining texels differ because the paper interpolates clip coordinates, while Strata
  // multiplies each position by the matrix.
  EXPECT_LE(counts.surface_differs * 100'000, counts.edited);
  EXPECT_EQ(counts.beyond_rounding, 0);
}

}  // namespace
}  // namespace strata::test
