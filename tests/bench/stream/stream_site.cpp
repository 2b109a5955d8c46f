#include "bench/stream/stream_site.h"

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <thread>

#include "bench/bench_mesh.h"
#include "bench/harness.h"
#include "bench/http_client.h"
#include "query/sampling/vertex_ply.h"

namespace strata::bench {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

[[noreturn]] void stop(const std::string& why) {
  std::fprintf(stderr, "strata-bench: %s\n", why.c_str());
  std::exit(1);
}

fs::path server_beside_us() { return fs::read_symlink("/proc/self/exe").parent_path() / "strata"; }

// Returns a file that ParaView can also read. Writes the mesh to `folder` if this process generates
// it.
fs::path ply_of(const std::string& model, const fs::path& cache, const fs::path& folder) {
  if (!is_generated(model)) {
    const auto files = must(mesh_files(model, cache));
    if (files.size() != 1 || files[0].path.extension() != ".ply")
      stop(model + " is no single PLY file");
    return fs::absolute(files[0].path);
  }
  const fs::path file = folder / "mesh.ply";
  std::ofstream out(file, std::ios::binary);
  const BenchMesh mesh = must(load_bench_mesh(model, {cache}));
  query::VertexPly(mesh.geometry, {}).write([&](std::span<const std::uint8_t> bytes) {
    return bool(
        out.write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size())));
  });
  if (!out.flush()) stop("cannot write " + file.string());
  return file;
}

std::string content_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

glm::dvec3 point(const json& numbers) { return {numbers.at(0), numbers.at(1), numbers.at(2)}; }

}  // namespace

StreamSite::StreamSite(const Settings& settings)
    : server_(settings.server.empty() ? server_beside_us() : settings.server),
      mesh_file_(ply_of(settings.model, settings.cache, server_.folder())),
      painted_(import(settings, "painted", settings.layers)),
      plain_(settings.has_plain && settings.layers > 0 ? import(settings, "plain", 0) : painted_) {}

Stage StreamSite::import(const Settings& settings, const std::string& name, int layers) {
  HttpClient http(server_.port(), server_.token());
  json job =
      json::parse(http.post("/models?filename=mesh.ply&unit=mm&up=z&name=" + name,
                            content_of(mesh_file_), "application/json", "application/octet-stream")
                      .body);
  const std::string job_path = "/jobs/" + job.at("id").dump();
  while (job.at("state") == "queued" || job.at("state") == "running") {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    job = json::parse(http.get(job_path).body);
  }
  if (job.at("state") != "done") stop("the import failed: " + job.dump());
  const std::string model_path = "/models/" + job.at("model").dump();
  const json model = json::parse(http.get(model_path).body);
  triangles_ = model.at("triangles");

  Stage stage;
  stage.model = model.at("slug");
  stage.layers = layers;
  stage.low = point(model.at("bounds").at("min"));
  stage.high = point(model.at("bounds").at("max"));
  stage.width = settings.width;
  stage.height = settings.height;
  stage.radius_px = settings.radius_px;
  for (int i = 0; i < layers; ++i) {
    const json layer{{"name", "Layer " + std::to_string(i)},
                     {"type", "u8"},
                     {"resolution", kResolution},
                     {"opacity", 0.6},
                     {"order", i}};
    stage.layer = json::parse(http.post(model_path + "/layers", layer.dump()).body).at("slug");
    const json fill{
        {"op", "fill"}, {"mode", "where"}, {"where", "true"}, {"value", 10 + 20 * (i % 12)}};
    http.post(model_path + "/layers/" + stage.layer + "/edits", fill.dump());
  }
  return stage;
}

}  // namespace strata::bench
