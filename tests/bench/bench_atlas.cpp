// Measures the atlas of each mesh: used texels, stretch and texel footprints, and the seconds and
// memory of each step.
#include <fstream>
#include <iostream>
#include <map>
#include <thread>

#include "bench/bench_commands.h"
#include "bench/bench_mesh.h"
#include "bench/harness.h"
#include "bench/step_watch.h"
#include "mesh/atlas/atlas.h"
#include "mesh/atlas/atlas_report.h"

namespace strata::bench {
namespace {

constexpr int kLowest = 2048;

struct Options {
  std::vector<std::string> meshes;
  std::string cache = "build/bench", json;
  std::vector<int> resolutions{2048, 4096, 8192};
  bool make_always = false, all = false;
};

nlohmann::json precision(const mesh::TriangleMesh& mesh, const mesh::Atlas& atlas, double area,
                         int resolution) {
  const auto owners = mesh::count_owners(mesh, atlas.corner_uvs, resolution);
  const double mean = area / double(std::max<std::uint64_t>(owners.covered, 1));
  const double largest = mesh::largest_texel_area(mesh, atlas.corner_uvs, resolution);
  return {{"resolution", resolution},       {"texels", owners.covered},
          {"shared_texels", owners.shared}, {"texel_area_mean", mean},
          {"texel_area_max", largest},      {"max_over_mean", largest / mean}};
}

nlohmann::json facts(const std::string& name, const Options& options) {
  StepWatch watch;
  Progress progress;
  const std::string title = mesh_title(name);
  auto loaded =
      watch.run("read", progress, [&] { return load_named_mesh(name, options.cache, progress); });
  if (!loaded) return {{"mesh", title}, {"refused", loaded.error().detail}};
  const mesh::TriangleMesh& mesh = loaded->mesh;
  Result<mesh::Atlas> atlas = fail(ErrorCode::invalid, "", "not tried");
  if (!options.make_always && !mesh.corner_uvs.empty())
    atlas = watch.run("keep", progress, [&] { return mesh::keep_uvs(mesh, kLowest, progress); });
  if (!atlas)
    atlas = watch.run("make", progress, [&] { return mesh::make_atlas(mesh, kLowest, progress); });
  if (!atlas)
    return {
        {"mesh", title}, {"triangles", mesh.triangle_count()}, {"refused", atlas.error().detail}};
  const double area = mesh::surface_area(mesh);
  nlohmann::json resolutions = nlohmann::json::array();
  for (const int resolution : options.resolutions)
    resolutions.push_back(precision(mesh, *atlas, area, resolution));
  const auto& report = atlas->report;
  return {{"mesh", title},
          {"triangles", mesh.triangle_count()},
          {"area", area},
          {"source", report.source},
          {"charts", report.charts},
          {"coverage", report.coverage},
          {"overlap", report.overlap},
          {"stretch_mean", report.stretch_mean},
          {"stretch_p99", report.stretch_p99},
          {"steps", watch.json()},
          {"seconds", watch.seconds()},
          {"cpu_seconds", watch.cpu_seconds()},
          {"peak_mib", watch.peak_mib()},
          {"resolutions", resolutions}};
}

void print(const nlohmann::json& row) {
  const auto name = row["mesh"].get<std::string>();
  if (row.contains("refused")) {
    std::printf("%-40s refused: %s\n", name.c_str(), row["refused"].get<std::string>().c_str());
  } else {
    const auto& first = row["resolutions"][0];
    std::printf(
        "%-40s %8llu %-5s charts %5d used %.3f stretch %.2f p99 %.2f largest/mean %.2f shared %llu  %6.2f s %6.2f s of "
        "processor %5.0f MiB\n",
        name.c_str(), row["triangles"].get<unsigned long long>(),
        row["source"].get<std::string>().c_str(), row["charts"].get<int>(),
        row["coverage"].get<double>(), row["stretch_mean"].get<double>(),
        row["stretch_p99"].get<double>(), first["max_over_mean"].get<double>(),
        first["shared_texels"].get<unsigned long long>(), row["seconds"].get<double>(),
        row["cpu_seconds"].get<double>(), row["peak_mib"].get<double>());
  }
  std::fflush(stdout);
}

int run(const Options& options) {
  nlohmann::json rows = nlohmann::json::array();
  bool any_refused = false;
  for (const auto& name : options.all ? must(all_meshes()) : options.meshes) {
    rows.push_back(facts(name, options));
    print(rows.back());
    any_refused |= rows.back().contains("refused");
  }
  write_result(options.json, machine(nullptr), rows);
  return options.all || !any_refused ? 0 : 1;
}

}  // namespace

Command add_atlas(CLI::App& app) {
  auto* command = app.add_subcommand(
      "atlas", "Facts of the atlas of each mesh: texels used, stretch, footprints, seconds");
  auto options = std::make_shared<Options>();
  command->add_option(
      "meshes", options->meshes,
      "Presets (vessel, excavation, amazon, thai, textured10m) or files that an import takes");
  command->add_flag(
      "--all", options->all,
      "Every mesh of the data folder, and the presets; those that are refused are named");
  command->add_option("--resolutions", options->resolutions, "Where footprints are measured")
      ->delimiter(',');
  command->add_flag("--make", options->make_always,
                    "Never keep the file's own texture coordinates");
  command->add_option("--cache", options->cache, "Where generated meshes are kept")
      ->capture_default_str();
  command->add_option("--json", options->json, "Write the results here");
  return [options] { return run(*options); };
}

}  // namespace strata::bench
