// Measures two durations: from the start of an import to the first frame of the model, and from the
// restart of a server whose model has painted layers to the first frame.
#include <cmath>
#include <iostream>

#include "bench/bench_commands.h"
#include "bench/bench_mesh.h"
#include "bench/harness.h"
#include "bench/step_watch.h"
#include "jobs/import_job.h"
#include "room/edit.h"
#include "room/layers.h"
#include "room/rooms.h"
#include "support/whole_picture.h"

namespace strata::bench {
namespace {

struct Options {
  std::string model = "excavation", cache = "build/bench", json;
  int layers = 3, resolution = 4096;
};

// Returns the full-detail frame of a resting camera in the given direction.
Picture frame(Site& site, const std::string& model, glm::dvec3 from) {
  auto room = must(site.rooms->open(model, Role::owner));
  const Model info = room->model();
  mesh::Geometry box;
  box.origin = (info.bounds_min + info.bounds_max) * 0.5;
  box.box_min = glm::vec3(info.bounds_min - box.origin);
  box.box_max = glm::vec3(info.bounds_max - box.origin);
  return must(test::whole_picture(room->pictures(), {}, look_at(box, from, 1280, 720)));
}
Picture first_frame(Site& site, const std::string& model) {
  return frame(site, model, {0.4, -1, 0.6});
}

// Measures frames with a new camera each time, so each frame draws the mesh.
Samples full_frames(Site& site, const std::string& model) {
  Samples samples;
  auto room = must(site.rooms->open(model, Role::owner));  // keeps the room open
  first_frame(site, model);
  for (int i = 0; i < 8; ++i) {
    const double angle = glm::radians(45.0 * i + 10);
    const double start = now_ms();
    frame(site, model, {std::cos(angle), std::sin(angle), 0.3});
    samples.add(now_ms() - start);
  }
  return samples;
}

int run(const Options& options) {
  Site site;
  jobs::ImportRequest request;
  request.files = must(mesh_files(options.model, options.cache));
  Progress progress;

  StepWatch watch;
  double start = now_ms();
  const Model model = must(watch.run(
      "start", progress, [&] { return jobs::import_model(*site.store, request, progress); }));
  const double import_ms = now_ms() - start;
  watch.run("first frame", progress, [&] { return first_frame(site, model.slug); });
  const double import_to_frame_ms = now_ms() - start;

  // Paint every layer, so a restart has data to load.
  auto room = must(site.rooms->open(model.slug, Role::owner));
  for (int i = 0; i < options.layers; ++i) {
    Layer layer;
    layer.name = layer.slug = "layer-" + std::to_string(i);
    layer.type = ValueType::u8;
    layer.resolution = options.resolution;
    layer.palette = default_palette(layer.type, false);
    layer.opacity = 0.6;
    layer = must(room->layers().create(layer));
    edit_and_wait(*room, {random_uuid(),
                          {"bench", Role::owner},
                          layer.id,
                          room::FillEdit{false, std::uint32_t(20 + 30 * i)},
                          {{"op", "fill"}}});
  }
  room.reset();

  start = now_ms();
  site.restart();
  const double ready_ms = now_ms() - start;
  room = must(site.rooms->open(model.slug, Role::owner));
  const double open_ms = now_ms() - start;
  first_frame(site, model.slug);
  const double restart_ms = now_ms() - start;
  const Samples full = full_frames(site, model.slug);

  const auto gpu = site.renderer->info();
  const nlohmann::json result{{"method", "import"},
                              {"model", options.model},
                              {"triangles", model.triangles},
                              {"atlas", to_json(model.atlas, model.metres())},
                              {"import_ms", import_ms},
                              {"steps", watch.json()},
                              {"peak_mib", watch.peak_mib()},
                              {"cpu_seconds", watch.cpu_seconds()},
                              {"import_to_first_frame_ms", import_to_frame_ms},
                              {"layers", options.layers},
                              {"texture", options.resolution},
                              {"restart_ready_ms", ready_ms},
                              {"restart_open_ms", open_ms},
                              {"restart_to_first_frame_ms", restart_ms},
                              {"full_frame", full.json()}};
  std::printf("%s: %llu triangles, %d charts, %.1f %% of texels used\n", options.model.c_str(),
              static_cast<unsigned long long>(model.triangles), model.atlas.charts,
              model.atlas.coverage * 100);
  std::printf(
      "import %.2f s, to the first frame %.2f s (%.2f s of processor), peak memory %.0f MiB\n",
      import_ms / 1000, import_to_frame_ms / 1000, watch.cpu_seconds(), watch.peak_mib());
  watch.print();
  std::printf(
      "restart with %d painted %d² layers: ready %.2f s, model open %.2f s, first frame %.2f s\n",
      options.layers, options.resolution, ready_ms / 1000, open_ms / 1000, restart_ms / 1000);
  std::printf("a frame of the full mesh from a new camera: %.0f ms (%.0f to %.0f)\n", full.median(),
              full.quantile(0), full.quantile(1));
  write_result(options.json, machine(&gpu), nlohmann::json::array({result}));
  return 0;
}

}  // namespace

Command add_import(CLI::App& app) {
  auto* command = app.add_subcommand(
      "import", "Import to first frame, and restart with painted layers to first frame");
  auto options = std::make_shared<Options>();
  command
      ->add_option("--model", options->model,
                   "vessel, excavation, amazon, thai, textured10m, or a file")
      ->capture_default_str();
  command->add_option("--layers", options->layers, "Painted layers at the restart")
      ->capture_default_str();
  command->add_option("--texture", options->resolution, "Their resolution")->capture_default_str();
  command->add_option("--cache", options->cache, "Where generated meshes are kept")
      ->capture_default_str();
  command->add_option("--json", options->json, "Write the results here");
  return [options] { return run(*options); };
}

}  // namespace strata::bench
