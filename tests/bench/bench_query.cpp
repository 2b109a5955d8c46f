// Values at points of a painted model, without the socket.
#include <iostream>
#include <random>

#include "bench/bench_commands.h"
#include "bench/bench_mesh.h"
#include "bench/harness.h"
#include "jobs/import_job.h"

namespace strata::bench {
namespace {

struct Options {
  std::string model = "excavation", cache = "build/bench", json;
  int points = 100'000;
};

int run(const Options& options) {
  Site site;
  jobs::ImportRequest request;
  request.files = must(mesh_files(options.model, options.cache));
  Progress progress;
  const Model model = must(jobs::import_model(*site.store, request, progress));
  auto room = must(site.rooms->open(model.slug));
  Layer layer;
  layer.name = layer.slug = "moisture";
  layer.type = ValueType::f32;
  layer.resolution = 4096;
  layer.palette = default_palette(layer.type, false);
  layer = must(room->create_layer(layer));
  edit_and_wait(
      *room,
      {random_uuid(), "bench", layer.id, room::FillEdit{false, must(encode_value(layer.type, 0.5))}, {{"op", "fill"}}});

  std::mt19937 random(1);
  auto anywhere = [&] {
    glm::dvec3 p;
    for (int i = 0; i < 3; ++i) p[i] = std::uniform_real_distribution(model.bounds_min[i], model.bounds_max[i])(random);
    return p;
  };
  double start = now_ms();
  must(room->position(anywhere(), {}));
  const double tree_ms = now_ms() - start;
  Samples single;
  for (int i = 0; i < 2000; ++i) {
    const auto point = anywhere();
    start = now_ms();
    must(room->position(point, {}));
    single.add(now_ms() - start);
  }
  std::vector<glm::dvec3> many(options.points);
  for (auto& p : many) p = anywhere();
  start = now_ms();
  must(room->positions(many, {}));
  const double many_ms = now_ms() - start;
  start = now_ms();
  must(room->statistics(layer.slug));
  const double statistics_ms = now_ms() - start;

  std::printf(
      "%s: search tree %.0f ms, one point p50 %.3f p99 %.3f ms, %d points %.0f ms, statistics at 4096² %.0f ms\n",
      options.model.c_str(), tree_ms, single.median(), single.quantile(0.99), options.points, many_ms, statistics_ms);
  const auto gpu = site.renderer->info();
  write_result(options.json, machine(&gpu),
               nlohmann::json::array({{{"method", "query"},
                                       {"model", options.model},
                                       {"triangles", model.triangles},
                                       {"tree_ms", tree_ms},
                                       {"position", single.json()},
                                       {"points", options.points},
                                       {"points_ms", many_ms},
                                       {"statistics_ms", statistics_ms}}}));
  return 0;
}

}  // namespace

Command add_query(CLI::App& app) {
  auto* command = app.add_subcommand("query", "Values at points and statistics");
  auto options = std::make_shared<Options>();
  command->add_option("--model", options->model, "vessel, excavation, amazon, thai, or a file")->capture_default_str();
  command->add_option("--points", options->points, "Points of the bulk query")->capture_default_str();
  command->add_option("--cache", options->cache, "Where generated meshes are kept")->capture_default_str();
  command->add_option("--json", options->json, "Write the results here");
  return [options] { return run(*options); };
}

}  // namespace strata::bench
