// Edits by the compute pass over tiles, beside the paper's own algorithms, on one context in one run.
#include <future>
#include <iostream>
#include <random>

#include "bench/bench_commands.h"
#include "bench/harness.h"
#include "bench/peers/paper.h"
#include "render/depth_buffers.h"
#include "render/edit_pass.h"
#include "render/mesh_buffers.h"
#include "support/shader_dirs.h"

namespace strata::bench {
namespace {

struct Options {
  std::vector<std::string> models{"pot:1000000"}, methods{"tiles", "paper"};
  std::vector<int> textures{2048, 4096, 8192}, radii{10, 40, 70, 100, 200};
  int repeats = 5;
  std::string cache = "build/bench", json;
};

constexpr int kWidth = 1280, kHeight = 720;
// Dabs on the model as `camera()` sees it; the same for every method.
const glm::dvec2 kCenters[] = {{640, 360}, {560, 400}, {700, 330}, {640, 290}, {580, 340}, {690, 420}, {620, 380}};

// What both methods are asked to paint on.
struct Scene {
  BenchMesh mesh;
  Camera camera;
  render::ModelHandle model = 0;
};

struct Measured {
  Samples edit, outcome;     // outcome: until the changed tiles are in main memory
  Samples cull, gpu;         // parts of the edit
  std::uint64_t texels = 0;  // of the last dab
  std::uint64_t bytes_up = 0, bytes_down = 0;
};

// The paper's system keeps its depth texture from drawing the scene; so does ours. Neither is timed here.
class PaperPeer {
 public:
  PaperPeer(render::Renderer& renderer, const Scene& scene, int resolution) : renderer_(renderer), scene_(scene) {
    renderer_.run_on_gpu_thread_for_test([&] {
      editor_ = must(PaperEditor::create(*scene.mesh.geometry, resolution));
      readback_ = std::make_unique<gl::ReadbackPool>();
      depths_ = std::make_unique<render::DepthBuffers>(
          must(render::DepthBuffers::create(test::shader_dir(), std::size_t{1} << 26, memory_, *readback_)));
      buffers_ = must(render::MeshBuffers::create(scene.mesh.geometry, memory_));
      while (!buffers_->upload_slice()) {
      }
      depth_ = must(depths_->start(render::depth_key(1, scene.camera, scene.camera.width, scene.camera.height)));
      render::MeshProgress progress;
      while (!must(depths_->draw_slice(depth_, *buffers_, scene.camera, progress))) {
      }
      glFinish();
    });
  }
  ~PaperPeer() {
    renderer_.run_on_gpu_thread_for_test([&] {
      depth_.reset();
      buffers_.reset();
      depths_.reset();
      editor_.reset();
      readback_.reset();
    });
  }

  double edit_ms(glm::dvec2 center, double radius) {
    double ms = 0;
    renderer_.run_on_gpu_thread_for_test([&] {
      glFinish();
      const double start = now_ms();
      editor_->edit(scene_.camera, depth_->texture, center, radius, 200);
      glFinish();
      ms = now_ms() - start;
    });
    return ms;
  }
  std::vector<std::uint8_t> mask_after(glm::dvec2 center, double radius) {
    std::vector<std::uint8_t> mask;
    renderer_.run_on_gpu_thread_for_test([&] {
      editor_->clear();
      editor_->edit(scene_.camera, depth_->texture, center, radius, 200);
      mask = editor_->mask();
    });
    return mask;
  }
  std::vector<std::uint8_t> coverage() {
    std::vector<std::uint8_t> coverage;
    renderer_.run_on_gpu_thread_for_test([&] { coverage = editor_->coverage(); });
    return coverage;
  }

 private:
  render::Renderer& renderer_;
  const Scene& scene_;
  render::GpuMemory memory_{std::uint64_t{1} << 40};
  std::unique_ptr<gl::ReadbackPool> readback_;
  std::unique_ptr<PaperEditor> editor_;
  std::unique_ptr<render::DepthBuffers> depths_;
  std::unique_ptr<render::MeshBuffers> buffers_;
  std::shared_ptr<render::DepthBuffer> depth_;
};

StrokeBatch dab(const Scene& scene, glm::dvec2 center, double radius) {
  StrokeBatch stroke;
  stroke.camera = scene.camera;
  stroke.path = {center};
  stroke.radius_px = radius;
  stroke.value_bits = 200;
  return stroke;
}

void measure_tiles(render::Renderer& renderer, render::LayerHandle layer, const Scene& scene, glm::dvec2 center,
                   double radius, Measured& measured) {
  const double start = now_ms();
  const auto outcome = await<render::StrokeOutcome>(
      [&](auto done) { renderer.paint(layer, dab(scene, center, radius), std::move(done)); });
  measured.outcome.add(now_ms() - start);
  measured.edit.add(outcome.dispatch_ms + outcome.gpu_ms);
  measured.cull.add(outcome.cull_ms);
  measured.gpu.add(outcome.gpu_ms);
  measured.texels = 0;
  for (const auto& tile : outcome.tiles) measured.texels += static_cast<std::uint64_t>(tile.written.count());
  measured.bytes_up = outcome.bytes_up;
  measured.bytes_down = outcome.tiles.size() * (kTexelsPerTile * 2 + sizeof(TileMask::words));
}

// Surface texels that one method painted and the other did not, and how many were painted.
std::pair<std::uint64_t, std::uint64_t> compare(render::Renderer& renderer, const Scene& scene,
                                                const mesh::SurfaceMap& map, PaperPeer& paper,
                                                const std::vector<std::uint8_t>& coverage, double radius) {
  const auto layer = await<render::LayerHandle>(
      [&](auto done) { renderer.add_layer(scene.model, ValueType::u8, map.resolution, std::move(done)); });
  const auto ours = await<render::StrokeOutcome>(
      [&](auto done) { renderer.paint(layer, dab(scene, kCenters[0], radius), std::move(done)); });
  renderer.remove_layer(layer);
  const auto theirs = paper.mask_after(kCenters[0], radius);
  std::vector<std::uint8_t> written(theirs.size());
  for (const auto& tile : ours.tiles)
    for (int i = 0; i < kTexelsPerTile; ++i)
      if (tile.written.test(i))
        written[std::size_t(tile.address.y * kTileSize + i / kTileSize) * map.resolution + tile.address.x * kTileSize +
                i % kTileSize] = 1;
  std::uint64_t differs = 0, edited = 0;
  for (std::size_t slot = 0; slot < map.block_of_slot.size(); ++slot)
    for (int i = 0; i < 64; ++i) {
      if (!(map.surface_mask[slot] >> i & 1)) continue;
      const std::size_t x = map.block_of_slot[slot] % map.blocks_per_side * 8 + i % 8;
      const std::size_t y = map.block_of_slot[slot] / map.blocks_per_side * 8 + i / 8;
      const std::size_t texel = y * map.resolution + x;
      if (!coverage[texel]) continue;
      edited += theirs[texel] || written[texel];
      differs += (theirs[texel] != 0) != (written[texel] != 0);
    }
  return {differs, edited};
}

nlohmann::json row(const std::string& method, const Scene& scene, int texture, int radius, const Measured& measured) {
  nlohmann::json json = measured.edit.json();
  json.update({{"method", method},
               {"model", scene.mesh.name},
               {"triangles", scene.mesh.geometry->triangle_count()},
               {"texture", texture},
               {"radius", radius},
               {"texels", measured.texels},
               {"bytes_up", measured.bytes_up},
               {"bytes_down", measured.bytes_down}});
  if (!measured.outcome.empty()) {
    json["ms_to_main_memory_median"] = measured.outcome.median();
    json["ms_cull_median"] = measured.cull.median();
    json["ms_gpu_median"] = measured.gpu.median();
  }
  return json;
}

void bench_texture(const Options& options, render::Renderer& renderer, const Scene& scene, int texture,
                   nlohmann::json& results) {
  const bool with_tiles = std::find(options.methods.begin(), options.methods.end(), "tiles") != options.methods.end();
  const bool with_paper = std::find(options.methods.begin(), options.methods.end(), "paper") != options.methods.end();
  Progress progress;
  double start = now_ms();
  auto map =
      std::make_shared<const mesh::SurfaceMap>(must(mesh::bake_surface_map(*scene.mesh.geometry, texture, progress)));
  const double bake_ms = now_ms() - start;
  await<void>([&](auto done) { renderer.add_surface_map(scene.model, map, std::move(done)); });
  const auto layer = await<render::LayerHandle>(
      [&](auto done) { renderer.add_layer(scene.model, ValueType::u8, texture, std::move(done)); });
  const auto empty_bytes = renderer.layer_bytes_used(layer);
  std::unique_ptr<PaperPeer> paper;
  std::vector<std::uint8_t> coverage;
  if (with_paper) {
    paper = std::make_unique<PaperPeer>(renderer, scene, texture);
    coverage = paper->coverage();
  }
  std::printf("\n%s, %zu triangles, %d²: map baked in %.2f s, %.0f MB; an empty layer %.0f KB\n",
              scene.mesh.name.c_str(), scene.mesh.geometry->triangle_count(), texture, bake_ms / 1000,
              double(map->bytes()) / 1e6, double(empty_bytes) / 1e3);
  std::printf("%6s %10s %12s %12s %12s %9s  %s\n", "r px", "texels", "tiles ms", "to memory", "paper ms", "ratio",
              "surface texels that differ");
  for (const int radius : options.radii) {
    Measured tiles, literal;
    Measured warm;
    if (with_tiles) measure_tiles(renderer, layer, scene, kCenters[0], radius, warm);
    if (with_paper) paper->edit_ms(kCenters[0], radius);
    for (int i = 0; i < options.repeats; ++i) {
      const auto center = kCenters[i % std::size(kCenters)];
      // A B B A: what drifts in the machine falls on both alike.
      const auto one = [&](bool is_tiles) {
        if (is_tiles && with_tiles) measure_tiles(renderer, layer, scene, center, radius, tiles);
        if (!is_tiles && with_paper) literal.edit.add(paper->edit_ms(center, radius));
      };
      one(true), one(false), one(false), one(true);
    }
    std::pair<std::uint64_t, std::uint64_t> difference{0, 0};
    if (with_tiles && with_paper) difference = compare(renderer, scene, *map, *paper, coverage, radius);
    literal.texels = tiles.texels;
    literal.bytes_up = 64;  // the tool matrix
    const double ratio = with_tiles && with_paper ? literal.edit.median() / tiles.edit.median() : 0;
    std::printf("%6d %10llu %12.3f %12.3f %12.2f %9.1f  %llu of %llu\n", radius,
                static_cast<unsigned long long>(tiles.texels), with_tiles ? tiles.edit.median() : 0,
                with_tiles ? tiles.outcome.median() : 0, with_paper ? literal.edit.median() : 0, ratio,
                static_cast<unsigned long long>(difference.first), static_cast<unsigned long long>(difference.second));
    std::fflush(stdout);
    if (with_tiles) {
      auto json = row("tiles", scene, texture, radius, tiles);
      if (with_paper) {
        json["ratio_paper"] = ratio;
        json["surface_texels_differ"] = difference.first;
        json["identical"] = difference.first * 100'000 <= difference.second;
      }
      json["empty_layer_bytes"] = empty_bytes;
      json["bake_ms"] = bake_ms;
      results.push_back(std::move(json));
    }
    if (with_paper) results.push_back(row("paper", scene, texture, radius, literal));
  }
  renderer.remove_layer(layer);
}

int run(const Options& options) {
  render::RendererOptions renderer_options;
  renderer_options.shader_dir = test::shader_dir().string();
  renderer_options.paper_depth_bias = true;  // so that both paint the same
  auto renderer = must(render::Renderer::start(renderer_options));
  const auto gpu = renderer->info();
  std::printf("%s, %s\n", gpu.renderer.c_str(), gpu.version.c_str());
  nlohmann::json results = nlohmann::json::array();
  for (const auto& name : options.models) {
    Scene scene{load_bench_mesh(name, options.cache), {}, 0};
    scene.camera = look_at(*scene.mesh.geometry, {0.45, -0.8, 0.5}, kWidth, kHeight);
    scene.model = await<render::ModelHandle>([&](auto done) {
      renderer->add_model({scene.mesh.geometry, {}}, std::move(done));
    });
    for (const int texture : options.textures) bench_texture(options, *renderer, scene, texture, results);
    renderer->remove_model(scene.model);
  }
  write_result(options.json, machine(&gpu), results);
  return 0;
}

}  // namespace

Command add_edit(CLI::App& app) {
  auto* command =
      app.add_subcommand("edit", "One dab of the brush: culling and dispatch, beside the paper's TEA + TPA");
  auto options = std::make_shared<Options>();
  command->add_option("--model", options->models, "pot[:TRIANGLES], vessel, excavation, amazon, thai, or files")
      ->delimiter(',')
      ->capture_default_str();
  command->add_option("--texture", options->textures, "Resolutions")
      ->delimiter(',')
      ->check(CLI::IsMember({2048, 4096, 8192, 16384}))
      ->capture_default_str();
  command->add_option("--radius", options->radii, "Brush radii in pixels")
      ->delimiter(',')
      ->check(CLI::Range(1, 2000))
      ->capture_default_str();
  command->add_option("--method", options->methods, "tiles, paper")
      ->delimiter(',')
      ->check(CLI::IsMember({"tiles", "paper"}))
      ->capture_default_str();
  command->add_option("--repeats", options->repeats, "A B B A rounds")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_option("--cache", options->cache, "Where generated meshes are kept")->capture_default_str();
  command->add_option("--json", options->json, "Write the results here");
  return [options] { return run(*options); };
}

}  // namespace strata::bench
