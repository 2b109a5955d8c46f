// Measures the processor time of frames of a moving camera, drawn with the shaders of two or more
// folders. The folders take turns frame by frame, so other programs affect all of them equally.
// Also measures whether the refinement of one view delays the pixels of a change in another view.
#include <cmath>
#include <ctime>
#include <iostream>
#include <thread>

#include "bench/bench_commands.h"
#include "bench/bench_mesh.h"
#include "bench/harness.h"
#include "mesh/surface/detail_levels.h"
#include "support/shader_dirs.h"

namespace strata::bench {
namespace {

struct Options {
  std::vector<std::string> models{"pot"}, shaders;
  std::string cache = "build/bench", json;
  int frames = 200, layers = 0, changes = 0;
};

// Returns the processor time of all threads, also of a driver that draws on the CPU.
double processor_ms() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) * 1e3 + static_cast<double>(time.tv_nsec) / 1e6;
}

class Drawer {
 public:
  Drawer(const std::string& shaders, const render::ModelGeometry& geometry, int layers) {
    render::RendererOptions options;
    options.shader_dir = shaders;
    renderer_ = must(render::Renderer::start(options));
    model_ = await<render::ModelHandle>(
        [&](auto done) { renderer_->add_model(geometry, std::move(done)); });
    view_ =
        await<render::ViewHandle>([&](auto done) { renderer_->add_view(model_, std::move(done)); });
    other_view_ =
        await<render::ViewHandle>([&](auto done) { renderer_->add_view(model_, std::move(done)); });
    for (int i = 0; i < layers; ++i) add_filled_layer(i);
  }

  double frame_ms(const Camera& camera, bool moving) {
    render::FrameRequest request = request_for(view_, camera);
    request.moving = moving;
    const double start = processor_ms();
    await<render::SharedFrame>([&](auto done) { renderer_->draw(request, std::move(done)); });
    return processor_ms() - start;
  }
  auto info() const { return renderer_->info(); }

  // Returns the time from the change of a tile to the frame that shows it. With `while_refining`,
  // the renderer refines the frame of another view in the meantime.
  double change_ms(const Camera& camera, std::uint32_t value, bool while_refining) {
    render::FrameRequest other = request_for(other_view_, camera);
    std::promise<void> over;
    if (while_refining) {
      other.samples = render::kMaxSamples;
      other.refinement = true;
      renderer_->draw(other, [&](const auto&) { over.set_value(); });
      std::this_thread::sleep_for(std::chrono::milliseconds(30));  // time to start the refinement
    }
    const double start = now_ms();
    auto tile = std::make_shared<TileData>(ValueType::u8);
    for (int i = 0; i < kTexelsPerTile; ++i) tile->write(i, value);
    renderer_->write_tiles(layer_, {{{3, 3}, tile}}, [](const auto&) {});
    render::FrameRequest request = request_for(view_, camera);
    request.changed = {{{glm::vec3(-1e3F), glm::vec3(1e3F)}}};
    await<render::SharedFrame>([&](auto done) { renderer_->draw(request, std::move(done)); });
    const double taken = now_ms() - start;
    if (while_refining) {
      other.samples = 1;
      other.refinement = false;  // supersedes the refinement
      await<render::SharedFrame>([&](auto done) { renderer_->draw(other, std::move(done)); });
      over.get_future().wait();
    }
    return taken;
  }

 private:
  render::FrameRequest request_for(render::ViewHandle view, const Camera& camera) const {
    render::FrameRequest request;
    request.view = view;
    request.camera = camera;
    request.width = camera.width;
    request.height = camera.height;
    request.style = style_;
    return request;
  }
  void add_filled_layer(int number) {
    constexpr int kResolution = 1024;
    const auto layer = await<render::LayerHandle>([&](auto done) {
      renderer_->add_layer(model_, ValueType::u8, kResolution, std::move(done));
    });
    auto tile = std::make_shared<TileData>(ValueType::u8);
    for (int i = 0; i < kTexelsPerTile; ++i)
      tile->write(i, static_cast<std::uint32_t>(10 + 20 * number));
    std::vector<render::TileUpload> tiles;
    for (std::uint16_t y = 0; y < kResolution / kTileSize; ++y)
      for (std::uint16_t x = 0; x < kResolution / kTileSize; ++x) tiles.push_back({{x, y}, tile});
    await<void>(
        [&](auto done) { renderer_->write_tiles(layer, std::move(tiles), std::move(done)); });
    const auto palette = std::make_shared<Palette>(default_palette(ValueType::u8, false));
    layer_ = layer;
    style_.layers.push_back({.layer = layer, .palette = palette, .opacity = 0.6F});
  }

  std::unique_ptr<render::Renderer> renderer_;
  render::ModelHandle model_ = 0;
  render::ViewHandle view_ = 0, other_view_ = 0;
  render::LayerHandle layer_ = 0;  // the topmost layer
  render::ViewStyle style_;
};

nlohmann::json measure_changes(Drawer& drawer, const mesh::Geometry& geometry,
                               const std::string& name, const Options& options) {
  const auto camera = look_at(geometry, {0.7, 0.7, 0.4}, 1280, 720);
  drawer.frame_ms(camera, false);
  Samples alone, refining;
  for (int i = 0; i < options.changes; ++i)
    for (const bool while_refining : {i % 2 == 0, i % 2 != 0})
      (while_refining ? refining : alone)
          .add(drawer.change_ms(camera, static_cast<std::uint32_t>(1 + i % 200), while_refining));
  std::printf(
      "%s: change → pixels p50 %.1f ms, p95 %.1f; while another view is refined %.1f, %.1f\n",
      mesh_title(name).c_str(), alone.median(), alone.quantile(0.95), refining.median(),
      refining.quantile(0.95));
  return {{"method", "changes"},
          {"model", mesh_title(name)},
          {"change_to_pixels", alone.json()},
          {"while_refining", refining.json()}};
}

nlohmann::json measure(const std::string& name, const Options& options, nlohmann::json& on) {
  Progress progress;
  auto loaded = must(load_bench_mesh(name, {options.cache}));
  render::ModelGeometry geometry;
  geometry.full = loaded.geometry;
  for (auto& level : must(mesh::make_detail_levels(*loaded.geometry, progress)))
    geometry.coarser.push_back(std::make_shared<const mesh::Geometry>(std::move(level)));
  std::vector<std::unique_ptr<Drawer>> drawers;
  for (const auto& shaders : options.shaders)
    drawers.push_back(std::make_unique<Drawer>(shaders, geometry, options.layers));
  const auto gpu = drawers.front()->info();
  on = machine(&gpu);

  if (options.changes > 0) return measure_changes(*drawers.front(), *geometry.full, name, options);
  const std::size_t count = drawers.size();
  std::vector<Samples> times(count), ratios(count);
  constexpr int kWarm = 6;
  for (int i = 0; i < options.frames + kWarm; ++i) {
    const double angle = 0.3 + i * 0.031;
    const auto camera = look_at(*geometry.full, {std::cos(angle), std::sin(angle), 0.4}, 1280, 720);
    std::vector<double> here(count);
    // The order is A B, then B A, because the first of a pair finds no data of the model in the
    // caches.
    for (std::size_t turn = 0; turn < count; ++turn) {
      const std::size_t at = i % 2 == 0 ? turn : count - 1 - turn;
      here[at] = drawers[at]->frame_ms(camera, true);
    }
    if (i < kWarm) continue;
    for (std::size_t at = 0; at < count; ++at) {
      times[at].add(here[at]);
      ratios[at].add(here[at] / here[0]);
    }
  }
  nlohmann::json result{{"method", "frames"},
                        {"model", mesh_title(name)},
                        {"triangles", geometry.full->triangle_count()},
                        {"layers", options.layers}};
  std::printf("%s, %zu triangles, %d layers\n", mesh_title(name).c_str(),
              geometry.full->triangle_count(), options.layers);
  for (std::size_t at = 0; at < count; ++at) {
    std::printf(
        "  %s: %.2f ms of processor time a frame (p25 %.2f, p75 %.2f); / first: %.4f (p25 %.4f, p75 %.4f)\n",
        options.shaders[at].c_str(), times[at].median(), times[at].quantile(0.25),
        times[at].quantile(0.75), ratios[at].median(), ratios[at].quantile(0.25),
        ratios[at].quantile(0.75));
    result["shaders"].push_back({{"folder", options.shaders[at]},
                                 {"processor_ms", times[at].median()},
                                 {"processor_ms_p25", times[at].quantile(0.25)},
                                 {"processor_ms_p75", times[at].quantile(0.75)},
                                 {"ratio_to_first", ratios[at].median()},
                                 {"ratio_p25", ratios[at].quantile(0.25)},
                                 {"ratio_p75", ratios[at].quantile(0.75)}});
  }
  std::fflush(stdout);
  return result;
}

int run(Options options) {
  if (options.shaders.empty()) options.shaders.push_back(test::shader_dir().string());
  nlohmann::json on, results = nlohmann::json::array();
  for (const auto& name : options.models) results.push_back(measure(name, options, on));
  write_result(options.json, on, results);
  return 0;
}

}  // namespace

Command add_frames(CLI::App& app) {
  auto* command = app.add_subcommand(
      "frames", "Processor time of frames of a moving camera, with several folders of shaders");
  auto options = std::make_shared<Options>();
  command
      ->add_option("--model", options->models,
                   "pot[:TRIANGLES], vessel, excavation, amazon, thai, or files")
      ->capture_default_str();
  command
      ->add_option("--shaders", options->shaders,
                   "Folders of shaders; the first is what the others are compared with")
      ->check(CLI::ExistingDirectory);
  auto* layers = command->add_option("--layers", options->layers, "Filled layers shown")
                     ->check(CLI::Range(0, 64))
                     ->capture_default_str();
  command->add_option("--frames", options->frames)
      ->check(CLI::Range(2, 100000))
      ->capture_default_str();
  command
      ->add_option(
          "--changes", options->changes,
          "Instead: times from a change of a layer to its pixels, while another view is refined or not")
      ->needs(layers);
  command->add_option("--cache", options->cache, "Where generated meshes are kept")
      ->capture_default_str();
  command->add_option("--json", options->json, "Write the results here");
  return [options] { return run(*options); };
}

}  // namespace strata::bench
