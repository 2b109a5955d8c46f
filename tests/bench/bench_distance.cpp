// Measures distances along the surface: a buffer of 20 mm around a spot and around a stripe, and
// the whole surface from a point, on a cylinder of 100 × 150 mm. Needs no database and no GPU.
#include <cmath>
#include <cstdio>
#include <ctime>
#include <limits>
#include <numbers>

#include "bench/bench_commands.h"
#include "bench/harness.h"
#include "core/progress.h"
#include "mesh/distance/surface_distance.h"
#include "support/cut_shapes.h"

namespace strata::bench {
namespace {

struct Options {
  std::string json;
  int runs = 5;
};

double cpu_ms() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) * 1e3 + static_cast<double>(time.tv_nsec) / 1e6;
}

test::Surface cylinder(const test::Cuts& cuts, int resolution) {
  constexpr double kTurn = 2 * std::numbers::pi;
  const test::Shape shape{256, 64,
                          [](double s, double t) {
                            return glm::dvec3(50 * std::cos(kTurn * s), 50 * std::sin(kTurn * s),
                                              150 * t);
                          },
                          [](double s, double t) { return glm::dvec2(50 * kTurn * s, 150 * t); }};
  return test::cut_surface(shape, cuts, resolution);
}

struct Case {
  const char* name;
  double limit;  // mm
  std::function<bool(glm::dvec3)> is_source;
};

nlohmann::json measure(const test::Surface& surface, const Case& each, int charts, int runs) {
  std::vector<std::uint64_t> sources(surface.map.block_of_slot.size(), 0);
  test::for_each_surface_texel(surface.map, [&](std::uint32_t texel) {
    const glm::dvec3 place =
        surface.geometry.origin +
        glm::dvec3(surface.map.position(texel / 64, static_cast<int>(texel % 64)));
    if (each.is_source(place)) sources[texel / 64] |= std::uint64_t{1} << texel % 64;
  });
  Samples wall, cpu;
  std::uint64_t reached = 0;
  std::size_t bytes = 0;
  for (int run = 0; run < runs; ++run) {
    Progress progress;
    const double wall_before = now_ms(), cpu_before = cpu_ms();
    const auto distances = must(
        mesh::distances_along_surface(surface.map, surface.graph, sources, each.limit, progress));
    wall.add(now_ms() - wall_before);
    cpu.add(cpu_ms() - cpu_before);
    reached = distances.reached_texels();
    bytes = distances.bytes();
  }
  std::printf("%d², %2d charts, %-32s %8llu texels %7.0f ms (%7.0f ms of processor) %6.1f MiB\n",
              surface.map.resolution, charts, each.name, static_cast<unsigned long long>(reached),
              wall.median(), cpu.median(), static_cast<double>(bytes) / (1 << 20));
  std::fflush(stdout);
  return {{"resolution", surface.map.resolution},
          {"charts", charts},
          {"case", each.name},
          {"texels", reached},
          {"wall", wall.json()},
          {"cpu", cpu.json()},
          {"bytes", bytes}};
}

int run(const Options& options) {
  const Case cases[] = {
      {"20 mm around a spot of 20 mm", 20,
       [](glm::dvec3 p) {
         return glm::distance(p, {50, 0, 75}) < 10;
       }},
      {"20 mm around a stripe", 20, [](glm::dvec3 p) { return std::abs(p.z - 75) < 2; }},
      {"the whole surface from a spot", std::numeric_limits<double>::infinity(), [](glm::dvec3 p) {
         return glm::distance(p, {50, 0, 75}) < 0.5;
       }}};
  nlohmann::json results = nlohmann::json::array();
  for (const int resolution : {2048, 4096})
    for (const test::Cuts cuts : {test::Cuts{1, 1, 0, 1}, test::Cuts{6, 3, 0.5, 0.8}}) {
      const test::Surface surface = cylinder(cuts, resolution);
      for (const Case& each : cases)
        results.push_back(measure(surface, each, cuts.columns * cuts.rows, options.runs));
    }
  write_result(options.json, machine(nullptr), results);
  return 0;
}

}  // namespace

Command add_distance(CLI::App& app) {
  auto* command = app.add_subcommand("distance", "Distances along the surface");
  auto options = std::make_shared<Options>();
  command->add_option("--runs", options->runs, "Runs of each case")->capture_default_str();
  command->add_option("--json", options->json, "Write the results here");
  return [options] { return run(*options); };
}

}  // namespace strata::bench
