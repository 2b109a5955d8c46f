// Measures edits with Strata's tiles, with the paper's algorithms, and with the octree to which the
// paper compares them. All methods use the same GL context in the same run.
#include <algorithm>
#include <cstdio>
#include <map>
#include <span>

#include "bench/bench_commands.h"
#include "bench/edit_methods.h"
#include "support/shader_dirs.h"

namespace strata::bench {
namespace {

const std::vector<std::string> kMethods{"tiles", "paper", "paper-compute", "octree", "octree-fair"};
const std::vector<std::string> kModels{"vessel", "excavation", "amazon", "thai"};

struct Options {
  std::vector<std::string> models{"vessel", "excavation"}, methods = kMethods;
  std::vector<int> textures{2048, 4096}, radii{10, 40, 70, 100, 200};
  int repeats = 2;
  bool full = false;
  std::string cache = "build/bench", json, edit_path = "automatic";
};

constexpr int kWidth = 1280, kHeight = 720;
// Centers of dabs on the model as `camera()` shows it. All methods use the same centers.
const glm::dvec2 kCenters[] = {{640, 360}, {560, 400}, {700, 330}, {640, 290},
                               {580, 340}, {690, 420}, {620, 380}};
constexpr std::size_t kCompared = 3;  // the number of leading centers that are compared
// The least memory traffic for one texel, in bytes: 8 for the position, 4 for the depth, 4 to read
// and write the value and the flag, and 4 for the unused rest of cache lines.
constexpr double kBytesPerTexel = 20;

struct Measured {
  Samples ms, to_memory, gpu;
  EditCost last;
};

// The measurements of one model, texture size and radius.
struct Case {
  std::map<std::string, Measured> of;
  EditAgreement agreement;
  bool has(const std::string& method) const { return of.contains(method); }
  double median(const std::string& method) const { return of.at(method).ms.median(); }
};

// Runs the methods in order and then in reverse (A B C C B A), so a drift of the machine's speed
// affects all of them equally.
Case measure(EditMethods& methods, int radius, int repeats) {
  Case result;
  for (const auto& method : methods.all()) method->edit(kCenters[0], radius);  // warm-up
  for (int round = 0; round < repeats; ++round) {
    const glm::dvec2 center = kCenters[static_cast<std::size_t>(round) % std::size(kCenters)];
    std::vector<EditMethod*> order;
    for (const auto& method : methods.all()) order.push_back(method.get());
    for (int turn = 0; turn < 2; ++turn) {
      for (EditMethod* method : order) {
        Measured& measured = result.of[method->name()];
        measured.last = method->edit(center, radius);
        measured.ms.add(measured.last.ms);
        if (measured.last.ms_to_memory > 0) measured.to_memory.add(measured.last.ms_to_memory);
        if (measured.last.gpu_ms > 0) measured.gpu.add(measured.last.gpu_ms);
      }
      std::reverse(order.begin(), order.end());
    }
  }
  if (methods.find("tiles") && methods.find("paper"))
    for (const glm::dvec2 center : std::span(kCenters).first(kCompared))
      result.agreement += methods.compare_tiles_and_paper(center, radius);
  return result;
}

class Report {
 public:
  Report(const Options& options, const render::GpuInfo& gpu, double bandwidth)
      : options_(options), machine_(machine(&gpu)), bandwidth_(bandwidth) {
    machine_["edit_path"] = gpu.edit_path == render::EditPath::kernel ? "kernel" : "compute";
  }

  void begin(const EditScene& scene, int texture, const EditMethods& methods) {
    scene_ = &scene;
    texture_ = texture;
    std::printf("\n%s, %zu triangles, %d²\n", scene.mesh.name.c_str(),
                scene.mesh.geometry->triangle_count(), texture);
    std::printf("  %-14s %11s %11s %13s %11s\n", "made", "seconds", "model MB", "structure MB",
                "layer MB");
    for (const auto& method : methods.all()) {
      const EditCreation c = method->creation();
      std::printf("  %-14s %11.2f %11.1f %13.1f %11.1f\n", method->name().c_str(), c.structure_s,
                  mb(c.model_bytes), mb(c.structure_bytes), mb(c.layer_bytes));
      creation_.push_back({{"method", method->name()},
                           {"model", scene.mesh.name},
                           {"triangles", scene.mesh.geometry->triangle_count()},
                           {"texture", texture},
                           {"seconds", c.structure_s},
                           {"model_bytes", c.model_bytes},
                           {"structure_bytes", c.structure_bytes},
                           {"layer_bytes", c.layer_bytes}});
    }
    for (const std::string& reason : methods.not_made()) {
      std::printf("  not run: %s\n", reason.c_str());
      not_run_.push_back({{"model", scene.mesh.name}, {"texture", texture}, {"why", reason}});
    }
    std::printf(
        "  ms an edit; × is how many times as long as tiles; floor is %.0f bytes a texel at %.1f GB/s\n",
        kBytesPerTexel, bandwidth_ / 1e9);
    std::printf("  %5s %9s %9s %7s", "r px", "texels", "tiles", "/floor");
    for (const auto& method : methods.all())
      if (method->name() != "tiles") std::printf(" %13s %7s", method->name().c_str(), "×");
    std::printf("  surface texels that differ\n");
  }

  void add(int radius, const Case& found) {
    const bool tiles = found.has("tiles");
    const double floor_ms = tiles ? static_cast<double>(found.of.at("tiles").last.cells) *
                                        kBytesPerTexel / bandwidth_ * 1000
                                  : 0;
    std::printf("  %5d %9llu %9.3f %7.1f", radius,
                tiles ? static_cast<unsigned long long>(found.of.at("tiles").last.cells) : 0ull,
                tiles ? found.median("tiles") : 0,
                tiles && floor_ms > 0 ? found.median("tiles") / floor_ms : 0);
    for (const std::string& method : options_.methods) {
      if (!found.has(method)) continue;
      results_.push_back(row(method, radius, found, floor_ms));
      if (method == "tiles") continue;
      std::printf(" %13.3f %7.1f", found.median(method),
                  tiles ? found.median(method) / found.median("tiles") : 0);
    }
    const EditAgreement& agreement = found.agreement;
    agreement_ += agreement;
    std::printf("  %llu of %llu (off: tiles %llu, paper %llu; beyond rounding %llu)\n",
                static_cast<unsigned long long>(agreement.differ),
                static_cast<unsigned long long>(agreement.compared),
                static_cast<unsigned long long>(agreement.tiles_off),
                static_cast<unsigned long long>(agreement.paper_off),
                static_cast<unsigned long long>(agreement.beyond_rounding));
    std::fflush(stdout);
    // Write after each case, so a long run that is stopped keeps its results.
    write_result(options_.json, machine_, results_,
                 {{"creation", creation_},
                  {"not_run", not_run_},
                  {"agreement", agreement_json(agreement_)},
                  {"copy_bytes_per_second", bandwidth_},
                  {"floor_bytes_per_texel", kBytesPerTexel}});
  }

 private:
  static nlohmann::json agreement_json(const EditAgreement& agreement) {
    return {{"surface_texels", agreement.compared},
            {"surface_texels_differ", agreement.differ},
            {"tiles_off", agreement.tiles_off},
            {"paper_off", agreement.paper_off},
            {"beyond_rounding", agreement.beyond_rounding},
            {"identical",
             agreement.differ * 100'000 <= agreement.compared && agreement.beyond_rounding == 0}};
  }
  static double mb(std::uint64_t bytes) { return static_cast<double>(bytes) / 1e6; }

  nlohmann::json row(const std::string& method, int radius, const Case& found,
                     double floor_ms) const {
    const Measured& measured = found.of.at(method);
    nlohmann::json json = measured.ms.json();
    json.update({{"method", method},
                 {"model", scene_->mesh.name},
                 {"triangles", scene_->mesh.geometry->triangle_count()},
                 {"texture", texture_},
                 {"radius", radius},
                 {"texels", measured.last.cells},
                 {"bytes_up", measured.last.bytes_up},
                 {"bytes_down", measured.last.bytes_down}});
    if (!measured.to_memory.empty()) json["ms_to_main_memory_median"] = measured.to_memory.median();
    if (!measured.gpu.empty()) json["gpu_ms_median"] = measured.gpu.median();
    if (method == "tiles") {
      json["floor_ms"] = floor_ms;
      if (const EditAgreement& agreement = found.agreement; agreement.compared > 0) {
        json.update(agreement_json(agreement));
      }
    } else if (found.has("tiles")) {
      json["ratio_to_tiles"] = measured.ms.median() / found.median("tiles");
    }
    return json;
  }

  const Options& options_;
  nlohmann::json machine_;
  const double bandwidth_;
  EditAgreement agreement_;  // sum over all cases
  const EditScene* scene_ = nullptr;
  int texture_ = 0;
  nlohmann::json results_ = nlohmann::json::array(), creation_ = nlohmann::json::array(),
                 not_run_ = nlohmann::json::array();
};

int run(Options options) {
  if (options.full) {
    options.models = kModels;
    options.textures = {2048, 4096, 8192};
  }
  render::RendererOptions renderer_options;
  renderer_options.shader_dir = test::shader_dir().string();
  renderer_options.edit_path = options.edit_path == "kernel"    ? render::EditPath::kernel
                               : options.edit_path == "compute" ? render::EditPath::compute
                                                                : render::EditPath::automatic;
  auto renderer = must(render::Renderer::start(renderer_options));
  const auto gpu = renderer->info();
  std::printf("%s, %s\n", gpu.renderer.c_str(), gpu.version.c_str());
  Report report(options, gpu, copy_bandwidth(*renderer));
  for (const auto& name : options.models) {
    EditScene scene{must(load_bench_mesh(name, {options.cache})), {}, 0};
    scene.camera = look_at(*scene.mesh.geometry, {0.45, -0.8, 0.5}, kWidth, kHeight);
    scene.model = await<render::ModelHandle>([&](auto done) {
      renderer->add_model({scene.mesh.geometry, {}}, std::move(done));
    });
    for (const int texture : options.textures) {
      EditMethods methods(*renderer, scene, texture, options.methods);
      report.begin(scene, texture, methods);
      for (const int radius : options.radii)
        report.add(radius, measure(methods, radius, options.repeats));
    }
    renderer->remove_model(scene.model);
  }
  return 0;
}

}  // namespace

Command add_edit(CLI::App& app) {
  auto* command = app.add_subcommand(
      "edit", "One dab of the brush, beside the paper's TEA + TPA and its octree rival");
  auto options = std::make_shared<Options>();
  command
      ->add_option("--model", options->models,
                   "pot[:TRIANGLES], vessel, excavation, amazon, thai, or files")
      ->delimiter(',')
      ->capture_default_str();
  command
      ->add_option("--texture", options->textures,
                   "Resolutions; the octree's depth is their logarithm")
      ->delimiter(',')
      ->check(CLI::IsMember({2048, 4096, 8192, 16384}))
      ->capture_default_str();
  command->add_option("--radius", options->radii, "Brush radii in pixels")
      ->delimiter(',')
      ->check(CLI::Range(1, 2000))
      ->capture_default_str();
  command
      ->add_option("--method", options->methods, "tiles, paper, paper-compute, octree, octree-fair")
      ->delimiter(',')
      ->check(CLI::IsMember(kMethods))
      ->capture_default_str();
  command->add_option("--repeats", options->repeats, "Rounds there and back")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_flag("--full", options->full,
                    "The paper's matrix: all four models at 2048, 4096 and 8192");
  command
      ->add_option("--edit-path", options->edit_path,
                   "How tiles are painted: automatic, compute, kernel")
      ->check(CLI::IsMember({"automatic", "compute", "kernel"}))
      ->capture_default_str();
  command->add_option("--cache", options->cache, "Where generated meshes are kept")
      ->capture_default_str();
  command->add_option("--json", options->json, "Write the results here, after each case");
  return [options] { return run(*options); };
}

}  // namespace strata::bench
