// Measures the operators on the values of a layer: seconds, processor seconds and peak memory of
// each, for meshes and resolutions, and how much they depend on the atlas. The values are waves
// through space, so they do not depend on the atlas. Needs no database and no GPU.
#include <malloc.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <optional>
#include <random>
#include <unordered_map>

#include "bench/bench_commands.h"
#include "bench/bench_mesh.h"
#include "bench/harness.h"
#include "bench/step_watch.h"
#include "core/progress.h"
#include "mesh/parallel.h"
#include "query/interpolation/interpolate.h"
#include "query/regions/border_line.h"
#include "query/regions/distance_values.h"
#include "query/regions/focal.h"
#include "query/regions/hysteresis.h"
#include "query/regions/line_depth.h"
#include "query/regions/majority.h"
#include "query/regions/open_close.h"
#include "query/regions/region_pieces.h"
#include "query/regions/run_off.h"
#include "query/regions/sieve.h"
#include "query/regions/watershed.h"
#include "support/surfaces.h"

namespace strata::bench {
namespace {

using query::SurfaceValues;

struct Options {
  std::vector<std::string> meshes;
  std::string cache = "build/bench", json;
  std::vector<int> resolutions{2048, 4096};
  std::vector<std::string> only;
  bool compares = false;
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
  const mesh::Geometry* geometry = nullptr;
  mesh::SurfaceMap map;
  mesh::TexelGraph graph;
  SurfaceValues numbers, classes, readings;
  double side = 0;  // of a square with the area of the surface, in model units

  glm::dvec3 place(std::uint32_t texel) const {
    return glm::dvec3(map.position(texel / 64, static_cast<int>(texel % 64)));
  }
};

Subject make_subject(const mesh::Geometry& geometry, int resolution) {
  Progress progress;
  Subject subject;
  subject.geometry = &geometry;
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
  bool of_classes;  // whether the result has classes, or numbers (f32)
  std::function<Result<SurfaceValues>(const Subject&, Progress&)> work;
};

SurfaceValues as_values(const std::vector<std::uint64_t>& selection) {
  SurfaceValues values{std::vector<std::uint32_t>(selection.size() * 64), selection};
  return values;
}

// Lengths are shares of the side of a square with the area of the surface. 0.5 % of it are about 14
// texels at 4096².
std::vector<Operator> operators() {
  const int threads = mesh::background_threads();
  const auto focal = [=](query::Focal statistic, bool of_classes, double share) {
    return [=](const Subject& on, Progress& progress) -> Result<SurfaceValues> {
      return query::focal_values(statistic, of_classes ? on.classes : on.numbers,
                                 of_classes ? ValueType::u32 : ValueType::f32, share * on.side,
                                 on.map, on.graph, "radius", progress, threads);
    };
  };
  const auto distance = [=](double share) {
    return [=](const Subject& on, Progress& progress) -> Result<SurfaceValues> {
      return query::distance_values(on.readings.valid, share * on.side, on.map, on.graph, progress,
                                    threads);
    };
  };
  const auto interpolated = [=](query::Interpolated what) {
    return [=](const Subject& on, Progress& progress) -> Result<SurfaceValues> {
      return query::interpolated_values(what, on.readings, ValueType::f32, 0.3 * on.side, on.map,
                                        on.graph, "range", progress, threads);
    };
  };
  const auto sieved = [](auto clean) {
    return [=](const Subject& on, Progress& progress) -> Result<SurfaceValues> {
      const auto regions = STRATA_TRY(query::find_regions(on.classes, on.map, on.graph, progress));
      return STRATA_TRY(clean(on, regions, 1e-4 * on.map.area_total, progress)).values;
    };
  };
  return {
      {"numbers, unchanged", false,
       [](const Subject& on, Progress&) -> Result<SurfaceValues> { return on.numbers; }},
      {"classes, unchanged", true,
       [](const Subject& on, Progress&) -> Result<SurfaceValues> { return on.classes; }},
      {"distance to areas, everywhere", false, distance(std::numeric_limits<double>::infinity())},
      {"buffer of 1 %", false, distance(0.01)},
      {"sieve", true,
       sieved([](const Subject& on, const query::Regions& regions, double area, Progress& p) {
         return query::sieve(on.classes, regions, area, query::SieveTo::longest_border, on.map,
                             on.graph, p);
       })},
      {"fill holes", true,
       sieved([](const Subject& on, const query::Regions& regions, double area, Progress& p) {
         return query::fill_holes(on.classes, regions, area, on.map, on.graph, p);
       })},
      {"majority, 0.3 %", true,
       [=](const Subject& on, Progress& progress) -> Result<SurfaceValues> {
         return query::majority(on.classes, {0.003 * on.side}, on.map, on.graph, progress, threads);
       }},
      {"open, 0.5 %", true,
       [=](const Subject& on, Progress& progress) -> Result<SurfaceValues> {
         return query::open_value(on.classes, 3, 0.005 * on.side, on.map, on.graph, progress,
                                  threads);
       }},
      {"close, 0.5 %", true,
       [=](const Subject& on, Progress& progress) -> Result<SurfaceValues> {
         return query::close_value(on.classes, 3, 0.005 * on.side, on.map, on.graph, progress,
                                   threads);
       }},
      {"border", true,
       [=](const Subject& on, Progress& progress) -> Result<SurfaceValues> {
         return as_values(STRATA_TRY(query::select_border_line(
             on.classes, {{}, 0.001 * on.side}, on.map, on.graph, progress, threads)));
       }},
      {"pieces", false,
       [=](const Subject& on, Progress& progress) -> Result<SurfaceValues> {
         auto pieces = STRATA_TRY(
             query::find_pieces(on.classes, {{}, 0, 100'000}, on.map, on.graph, progress, threads));
         // The area of its piece for each texel.
         SurfaceValues areas{std::move(pieces.of_texel), on.map.surface_mask};
         for (std::uint32_t& index : areas.bits)
           index = index == query::kNoRegion
                       ? 0
                       : std::bit_cast<std::uint32_t>(static_cast<float>(pieces.list[index].area));
         return areas;
       }},
      {"mean, 0.2 %", false, focal(query::Focal::mean, false, 0.002)},
      {"mean, 0.5 %", false, focal(query::Focal::mean, false, 0.005)},
      {"greatest value, 0.5 %", false, focal(query::Focal::max, false, 0.005)},
      {"variety, 0.5 %", false, focal(query::Focal::variety, true, 0.005)},
      {"hot spots, 0.5 %", false, focal(query::Focal::hot_spot, false, 0.005)},
      {"cracks (valley), 0.2 %", false,
       [=](const Subject& on, Progress& progress) -> Result<SurfaceValues> {
         return query::line_depth_values(query::Line::valley, on.numbers, ValueType::f32,
                                         0.002 * on.side, on.map, on.graph, "width", progress,
                                         threads);
       }},
      {"hysteresis", true,
       [=](const Subject& on, Progress& progress) -> Result<SurfaceValues> {
         return query::hysteresis_values(on.numbers, ValueType::f32, {0.5, 1.0}, on.map, on.graph,
                                         progress);
       }},
      {"run-off", false,
       [=](const Subject& on, Progress& progress) -> Result<SurfaceValues> {
         const std::vector<std::uint64_t> no_drips(on.map.block_of_slot.size(), 0);
         // An owner of nothing: the geometry outlives the subject.
         const std::shared_ptr<const mesh::Geometry> geometry(std::shared_ptr<void>(), on.geometry);
         const glm::dvec3 up(0, 0, 1);
         const auto falls =
             STRATA_TRY(query::WaterFalls::make(geometry, on.map, on.graph, up, progress));
         return STRATA_TRY(query::run_off(on.numbers, ValueType::f32, up, no_drips, falls, on.map,
                                          on.graph, progress))
             .passing;
       }},
      {"watershed", false,
       [=](const Subject& on, Progress& progress) -> Result<SurfaceValues> {
         auto basins = STRATA_TRY(query::watershed_values(on.numbers, ValueType::f32, 0.2, on.map,
                                                          on.graph, "height", progress));
         // The area of its basin for each texel.
         std::vector<float> areas(query::kMaxBasins + 1);
         const auto basin_of = [&](std::uint32_t texel) {
           return static_cast<std::size_t>(std::bit_cast<float>(basins.bits[texel]));
         };
         test::for_each_surface_texel(
             on.map, [&](std::uint32_t texel) { areas[basin_of(texel)] += on.map.area[texel]; });
         test::for_each_surface_texel(on.map, [&](std::uint32_t texel) {
           basins.bits[texel] = std::bit_cast<std::uint32_t>(areas[basin_of(texel)]);
         });
         return basins;
       }},
      {"interpolated", false, interpolated(query::Interpolated::mean)},
      {"interpolation error", false, interpolated(query::Interpolated::error)},
  };
}

struct Measured {
  Result<SurfaceValues> values;
  nlohmann::json json;
};

Measured measure(const Operator& each, const Subject& subject) {
  StepWatch watch;
  Progress progress;
  malloc_trim(0);  // otherwise the memory of the operator before hides that of this one
  const double memory_before = memory_mib();
  auto values = watch.run(each.name, progress, [&] { return each.work(subject, progress); });
  const double memory = watch.peak_mib() - memory_before;
  if (!values) {
    std::printf("  %-32s refused: %s", each.name, values.error().detail.c_str());
    nlohmann::json refused{{"operator", each.name}, {"refused", values.error().detail}};
    return {std::move(values), std::move(refused)};
  }
  std::printf("  %-32s %8.2f s %8.2f s of processor %7.0f MiB", each.name, watch.seconds(),
              watch.cpu_seconds(), memory);
  return {std::move(values),
          {{"operator", each.name},
           {"seconds", watch.seconds()},
           {"cpu_seconds", watch.cpu_seconds()},
           {"added_mib", memory}}};
}

// For texels of one surface, the nearest texels of another atlas of the same surface.
std::vector<std::pair<std::uint32_t, std::uint32_t>> same_places(const Subject& a,
                                                                 const Subject& b) {
  constexpr std::size_t kPlaces = 200'000;
  const double cell = 2 * std::sqrt(b.map.area_total / double(b.map.surface_texels));
  const auto cell_of = [&](glm::dvec3 at) { return glm::i64vec3(glm::floor(at / cell)); };
  const auto key_of = [](glm::i64vec3 at) {
    return static_cast<std::uint64_t>(at.x * 73856093 ^ at.y * 19349663 ^ at.z * 83492791);
  };
  std::unordered_multimap<std::uint64_t, std::uint32_t> cells;
  cells.reserve(b.map.surface_texels);
  test::for_each_surface_texel(
      b.map, [&](std::uint32_t texel) { cells.emplace(key_of(cell_of(b.place(texel))), texel); });
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  const std::uint64_t step = std::max<std::uint64_t>(1, a.map.surface_texels / kPlaces);
  std::uint64_t number = 0;
  test::for_each_surface_texel(a.map, [&](std::uint32_t texel) {
    if (number++ % step != 0) return;
    const glm::dvec3 at = a.place(texel);
    double nearest = cell * cell;
    std::uint32_t found = mesh::kNoNeighbour;
    for (int i = 0; i < 27; ++i) {
      const auto beside = cell_of(at) + glm::i64vec3(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
      const auto [first, last] = cells.equal_range(key_of(beside));
      for (auto other = first; other != last; ++other) {
        const glm::dvec3 way = b.place(other->second) - at;
        if (glm::dot(way, way) >= nearest) continue;
        nearest = glm::dot(way, way);
        found = other->second;
      }
    }
    if (found != mesh::kNoNeighbour) pairs.emplace_back(texel, found);
  });
  return pairs;
}

// How much the values of two atlases differ at the same places: for classes, the share of places
// with another class; for numbers, the root mean square of the difference and the 99th percentile,
// in standard deviations of the values.
nlohmann::json difference(const Operator& each, const SurfaceValues& a, const SurfaceValues& b,
                          const std::vector<std::pair<std::uint32_t, std::uint32_t>>& places) {
  std::size_t other = 0;
  double sum = 0, squares = 0, of_difference = 0;
  std::vector<double> differences;
  for (const auto& [in_a, in_b] : places) {
    const query::TexelValue va = a.of(in_a), vb = b.of(in_b);
    if (va.valid != vb.valid || (each.of_classes && va != vb)) ++other;
    if (each.of_classes || !va.valid || !vb.valid) continue;
    const double na = double{std::bit_cast<float>(va.bits)},
                 nb = double{std::bit_cast<float>(vb.bits)};
    sum += na;
    squares += na * na;
    of_difference += (na - nb) * (na - nb);
    differences.push_back(std::abs(na - nb));
  }
  nlohmann::json json{{"other_share", double(other) / double(places.size())}};
  std::printf("   differs at %.3f %%", 100 * double(other) / double(places.size()));
  if (differences.empty()) return json;
  const double count = double(differences.size()),
               deviation = std::sqrt(std::max(0.0, squares / count - sum * sum / count / count));
  const auto p99 = differences.begin() + static_cast<std::ptrdiff_t>(0.99 * (count - 1));
  std::ranges::nth_element(differences, p99);
  json["rms"] = std::sqrt(of_difference / count) / deviation;
  json["p99"] = *p99 / deviation;
  std::printf(", by %.4f rms, %.4f p99", json["rms"].get<double>(), json["p99"].get<double>());
  return json;
}

bool is_chosen(const Operator& each, const Options& options) {
  if (options.only.empty()) return true;
  return std::ranges::any_of(options.only, [&](const std::string& part) {
    return std::string_view(each.name).find(part) != std::string_view::npos;
  });
}

nlohmann::json measure_all(const BenchMesh& mesh, int resolution, const Options& options) {
  const Subject subject = make_subject(*mesh.geometry, resolution);
  std::printf("%s, %d², %llu texels, %d charts, %zu links\n", mesh_title(mesh.name).c_str(),
              resolution, static_cast<unsigned long long>(subject.map.surface_texels),
              mesh.atlas.charts, subject.graph.links.size());
  std::optional<Subject> other;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> places;
  nlohmann::json row{{"mesh", mesh_title(mesh.name)},
                     {"resolution", resolution},
                     {"texels", subject.map.surface_texels},
                     {"charts", mesh.atlas.charts}};
  if (options.compares) {
    const BenchMesh other_mesh =
        must(load_bench_mesh(mesh.name, {.cache = options.cache, .other_atlas = true}));
    other = make_subject(*other_mesh.geometry, resolution);
    places = same_places(subject, *other);
    row["other_charts"] = other_mesh.atlas.charts;
    std::printf("  compared at %zu places with an atlas of %d charts\n", places.size(),
                other_mesh.atlas.charts);
  }
  nlohmann::json results = nlohmann::json::array();
  for (const Operator& each : operators()) {
    if (!is_chosen(each, options)) continue;
    Measured measured = measure(each, subject);
    if (other && measured.values) {
      Progress progress;
      measured.json["difference"] =
          difference(each, *measured.values, must(each.work(*other, progress)), places);
    }
    std::printf("\n");
    std::fflush(stdout);
    results.push_back(std::move(measured.json));
  }
  row["operators"] = std::move(results);
  return row;
}

int run(const Options& options) {
  nlohmann::json rows = nlohmann::json::array();
  for (const std::string& name : options.meshes) {
    const BenchMesh mesh = must(load_bench_mesh(name, {.cache = options.cache}));
    for (const int resolution : options.resolutions)
      rows.push_back(measure_all(mesh, resolution, options));
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
  command->add_flag("--compare", options->compares,
                    "Also compute the values on another atlas, and print the differences");
  command->add_option("--cache", options->cache, "Where generated meshes are kept")
      ->capture_default_str();
  command->add_option("--json", options->json, "Write the results here");
  return [options] { return run(*options); };
}

}  // namespace strata::bench
