// Measures the operators on the values of a layer: seconds, processor seconds and peak memory of
// each, for meshes and resolutions. The values are waves through space, so they do not depend on
// the atlas. Needs no database and no GPU.
#include <malloc.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <random>

#include "bench/bench_commands.h"
#include "bench/bench_mesh.h"
#include "bench/harness.h"
#include "bench/step_watch.h"
#include "core/progress.h"
#include "mesh/distance/surface_distance.h"
#include "mesh/parallel.h"
#include "query/interpolation/interpolate.h"
#include "query/regions/border_line.h"
#include "query/regions/focal.h"
#include "query/regions/majority.h"
#include "query/regions/open_close.h"
#include "query/regions/region_pieces.h"
#include "query/regions/sieve.h"

namespace strata::bench {
namespace {

using query::SurfaceValues;

struct Options {
  std::vector<std::string> meshes;
  std::string cache = "build/bench", json;
  std::vector<int> resolutions{2048, 4096};
  std::vector<std::string> only;
};

// A number for each place: a sum of waves with about the given length.
class Waves {
 public:
  Waves(double length, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal(0, 2 * std::numbers::pi / length);
    std::uniform_real_distribution<double> turn(0, 2 * std::numbers::pi);
    for (Wave& wave : waves_)
      wave = {{normal(random), normal(random), normal(random)}, turn(random)};
  }
  double at(glm::dvec3 place) const {
    double sum = 0;
    for (const Wave& wave : waves_) sum += std::sin(glm::dot(wave.direction, place) + wave.phase);
    return sum / std::sqrt(waves_.size() / 2.0);
  }

 private:
  struct Wave {
    glm::dvec3 direction;
    double phase;
  };
  std::array<Wave, 12> waves_;
};

// Calls value(place) for each surface texel: its bits, or nothing.
template <class Value>
SurfaceValues make_values(const mesh::SurfaceMap& map, Value value) {
  SurfaceValues values{std::vector<std::uint32_t>(map.block_of_slot.size() * 64),
                       std::vector<std::uint64_t>(map.block_of_slot.size())};
  mesh::parallel_for(2, static_cast<int>(map.block_of_slot.size()), [&](int index) {
    const auto slot = static_cast<std::uint32_t>(index);
    for (std::uint64_t left = map.surface_mask[slot]; left != 0; left &= left - 1) {
      const int i = std::countr_zero(left);
      if (const auto bits = value(glm::dvec3(map.position(slot, i))))
        values.set(slot * 64 + static_cast<std::uint32_t>(i), {*bits, true});
    }
  });
  return values;
}

// What the operators work on, and the lengths that they use.
struct Subject {
  mesh::SurfaceMap map;
  mesh::TexelGraph graph;
  SurfaceValues numbers, classes, readings;
  double side = 0;  // of a square with the area of the surface, in model units
};

Subject make_subject(const mesh::Geometry& geometry, int resolution) {
  Progress progress;
  Subject subject;
  subject.map = must(mesh::bake_surface_map(geometry, resolution, progress));
  subject.graph = must(mesh::build_texel_graph(geometry, subject.map, progress));
  subject.side = std::sqrt(subject.map.area_total);
  const Waves number(subject.side / 10, 1), unpainted(subject.side / 20, 2);
  subject.numbers = make_values(subject.map, [&](glm::dvec3 place) {
    return std::optional(std::bit_cast<std::uint32_t>(static_cast<float>(number.at(place))));
  });
  subject.classes = make_values(subject.map, [&](glm::dvec3 place) -> std::optional<std::uint32_t> {
    if (unpainted.at(place) > 0.5) return std::nullopt;
    return static_cast<std::uint32_t>(std::clamp(std::lround(3 + 2 * number.at(place)), 1L, 6L));
  });
  // Spots of readings around the crests of waves.
  const Waves crest(subject.side / 6, 3);
  subject.readings =
      make_values(subject.map, [&](glm::dvec3 place) -> std::optional<std::uint32_t> {
        if (crest.at(place) < 1.9) return std::nullopt;
        return std::bit_cast<std::uint32_t>(
            static_cast<float>(std::round(100 * number.at(place / 100.0)) / 10));
      });
  return subject;
}

struct Operator {
  const char* name;
  std::function<void(const Subject&, Progress&)> work;
};

// Lengths are shares of the side of a square with the area of the surface. 0.5 % of it are about 14
// texels at 4096².
std::vector<Operator> operators() {
  const int threads = mesh::background_threads();
  const auto focal = [=](query::Focal statistic, bool of_classes, double share) {
    return [=](const Subject& on, Progress& progress) {
      must(query::focal_values(statistic, of_classes ? on.classes : on.numbers,
                               of_classes ? ValueType::u32 : ValueType::f32, share * on.side,
                               on.map, on.graph, "radius", progress, threads));
    };
  };
  const auto distance = [=](double share) {
    return [=](const Subject& on, Progress& progress) {
      must(mesh::distances_along_surface(on.map, on.graph, on.readings.valid, share * on.side,
                                         progress, threads));
    };
  };
  const auto interpolated = [=](query::Interpolated what) {
    return [=](const Subject& on, Progress& progress) {
      must(query::interpolated_values(what, on.readings, ValueType::f32, 0.3 * on.side, on.map,
                                      on.graph, "range", progress, threads));
    };
  };
  const auto sieved = [](auto clean) {
    return [=](const Subject& on, Progress& progress) {
      const auto regions = must(query::find_regions(on.classes, on.map, on.graph, progress));
      must(clean(on, regions, 1e-4 * on.map.area_total, progress));
    };
  };
  return {
      {"distance to areas, everywhere", distance(std::numeric_limits<double>::infinity())},
      {"buffer of 1 %", distance(0.01)},
      {"sieve",
       sieved([](const Subject& on, const query::Regions& regions, double area, Progress& p) {
         return query::sieve(on.classes, regions, area, query::SieveTo::longest_border, on.map,
                             on.graph, p);
       })},
      {"fill holes",
       sieved([](const Subject& on, const query::Regions& regions, double area, Progress& p) {
         return query::fill_holes(on.classes, regions, area, on.map, on.graph, p);
       })},
      {"majority, 0.3 %",
       [=](const Subject& on, Progress& progress) {
         must(query::majority(on.classes, {0.003 * on.side}, on.map, on.graph, progress, threads));
       }},
      {"open, 0.5 %",
       [=](const Subject& on, Progress& progress) {
         must(query::open_value(on.classes, 3, 0.005 * on.side, on.map, on.graph, progress,
                                threads));
       }},
      {"close, 0.5 %",
       [=](const Subject& on, Progress& progress) {
         must(query::close_value(on.classes, 3, 0.005 * on.side, on.map, on.graph, progress,
                                 threads));
       }},
      {"border",
       [=](const Subject& on, Progress& progress) {
         must(query::select_border_line(on.classes, {{}, 0.001 * on.side}, on.map, on.graph,
                                        progress, threads));
       }},
      {"pieces",
       [=](const Subject& on, Progress& progress) {
         must(
             query::find_pieces(on.classes, {{}, 0, 100'000}, on.map, on.graph, progress, threads));
       }},
      {"mean, 0.2 %", focal(query::Focal::mean, false, 0.002)},
      {"mean, 0.5 %", focal(query::Focal::mean, false, 0.005)},
      {"greatest value, 0.5 %", focal(query::Focal::max, false, 0.005)},
      {"variety, 0.5 %", focal(query::Focal::variety, true, 0.005)},
      {"hot spots, 0.5 %", focal(query::Focal::hot_spot, false, 0.005)},
      {"interpolated", interpolated(query::Interpolated::mean)},
      {"interpolation error", interpolated(query::Interpolated::error)},
  };
}

nlohmann::json measure(const Operator& each, const Subject& subject) {
  StepWatch watch;
  Progress progress;
  malloc_trim(0);  // otherwise the memory of the operator before hides that of this one
  const double memory_before = memory_mib();
  watch.run(each.name, progress, [&] {
    each.work(subject, progress);
    return 0;
  });
  const double memory = watch.peak_mib() - memory_before;
  std::printf("  %-32s %8.2f s %8.2f s of processor %7.0f MiB\n", each.name, watch.seconds(),
              watch.cpu_seconds(), memory);
  std::fflush(stdout);
  return {{"operator", each.name},
          {"seconds", watch.seconds()},
          {"cpu_seconds", watch.cpu_seconds()},
          {"added_mib", memory}};
}

bool is_chosen(const Operator& each, const Options& options) {
  if (options.only.empty()) return true;
  return std::ranges::any_of(options.only, [&](const std::string& part) {
    return std::string_view(each.name).find(part) != std::string_view::npos;
  });
}

int run(const Options& options) {
  nlohmann::json rows = nlohmann::json::array();
  for (const std::string& name : options.meshes) {
    const BenchMesh mesh = must(load_bench_mesh(name, {.cache = options.cache}));
    for (const int resolution : options.resolutions) {
      const Subject subject = make_subject(*mesh.geometry, resolution);
      std::printf("%s, %d², %llu texels, %u charts, %zu links\n", mesh_title(name).c_str(),
                  resolution, static_cast<unsigned long long>(subject.map.surface_texels),
                  mesh.atlas.charts, subject.graph.links.size());
      nlohmann::json results = nlohmann::json::array();
      for (const Operator& each : operators())
        if (is_chosen(each, options)) results.push_back(measure(each, subject));
      rows.push_back({{"mesh", mesh_title(name)},
                      {"resolution", resolution},
                      {"texels", subject.map.surface_texels},
                      {"charts", mesh.atlas.charts},
                      {"operators", results}});
    }
  }
  write_result(options.json, machine(nullptr), rows);
  return 0;
}

}  // namespace

Command add_operators(CLI::App& app) {
  auto* command = app.add_subcommand(
      "operators", "Analysis of layers: seconds and memory of each operator, on meshes");
  auto options = std::make_shared<Options>();
  command->add_option("meshes", options->meshes, "Meshes as in `atlas`, or pot:TRIANGLES")
      ->required();
  command->add_option("--resolutions", options->resolutions, "Sides of the atlas in texels")
      ->delimiter(',');
  command->add_option("--only", options->only, "Only operators whose name contains one of these")
      ->delimiter(',');
  command->add_option("--cache", options->cache, "Where generated meshes are kept")
      ->capture_default_str();
  command->add_option("--json", options->json, "Write the results here");
  return [options] { return run(*options); };
}

}  // namespace strata::bench
