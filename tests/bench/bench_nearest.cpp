// Compares two searches for the nearest point of the surface: Strata's search tree and Embree's
// point query.
#include <embree3/rtcore.h>
#include <malloc.h>

#include <atomic>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <limits>
#include <random>

#include "bench/bench_commands.h"
#include "bench/bench_mesh.h"
#include "bench/harness.h"
#include "mesh/surface/search_tree.h"

namespace strata::bench {
namespace {

struct Options {
  std::string model = "excavation", cache = "build/bench", json;
  int points = 200'000;
};

// Returns the memory that malloc has allocated, in MiB.
double allocated_mib() {
  const struct mallinfo2 info = mallinfo2();
  return static_cast<double>(info.uordblks + info.hblkhd) / (1 << 20);
}

double cpu_seconds() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_nsec) / 1e9;
}

struct Measured {
  double build_ms = 0, build_cpu_ms = 0, mib = 0;
  std::vector<double> query_us;    // processor time, one value for each set of points
  std::vector<float> distances{};  // distances of all sets
};

// Makes sets of points as in real queries: points of records on the surface, points of measurements
// near it, and cameras far from it.
std::vector<std::vector<glm::vec3>> point_sets(const mesh::Geometry& geometry, int count) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> any(0, 1);
  const glm::vec3 size = geometry.box_max - geometry.box_min;
  std::vector<std::vector<glm::vec3>> sets(3);
  for (int i = 0; i < count; ++i) {
    const std::size_t triangle = random() % geometry.triangle_count();
    const auto corner = [&](std::size_t k) {
      return geometry.vertices[geometry.indices[3 * triangle + k]].position;
    };
    const glm::vec3 middle = (corner(0) + corner(1) + corner(2)) / 3.f;
    const glm::vec3 within(any(random), any(random), any(random));
    sets[0].push_back(middle);
    sets[1].push_back(middle + (within - 0.5f) * 0.02f * glm::length(size));
    sets[2].push_back(geometry.box_min + (3.f * within - 1.f) * size);
  }
  return sets;
}
constexpr const char* kSets[] = {"on the surface", "within 1 % of the size", "around the model"};

// Source: Ericson, Real-Time Collision Detection, 5.1.5. Uses double precision, as Strata's tree
// does.
glm::dvec3 nearest_in_triangle(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b,
                               const glm::dvec3& c) {
  const glm::dvec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = glm::dot(ab, ap), d2 = glm::dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const double d3 = glm::dot(ab, bp), d4 = glm::dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const double d5 = glm::dot(ab, cp), d6 = glm::dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const double vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + ab * (d1 / (d1 - d3));
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + ac * (d2 / (d2 - d6));
  if (va <= 0 && d4 >= d3 && d5 >= d6) return b + (c - b) * ((d4 - d3) / (d4 - d3 + d5 - d6));
  return a + (ab * vb + ac * vc) / (va + vb + vc);
}

struct EmbreeQuery {
  const mesh::Geometry& geometry;
  glm::dvec3 point;
  double squared = std::numeric_limits<double>::infinity();
};

bool visit_triangle(RTCPointQueryFunctionArguments* arguments) {
  auto& query = *static_cast<EmbreeQuery*>(arguments->userPtr);
  const std::uint32_t* corner = &query.geometry.indices[3 * std::size_t{arguments->primID}];
  const auto position = [&](std::size_t k) {
    return glm::dvec3(query.geometry.vertices[corner[k]].position);
  };
  const glm::dvec3 way =
      nearest_in_triangle(query.point, position(0), position(1), position(2)) - query.point;
  const double squared = glm::dot(way, way);
  if (squared >= query.squared) return false;
  query.squared = squared;
  // Round the radius up, so the search omits no nearer point.
  arguments->query->radius =
      std::nextafter(static_cast<float>(std::sqrt(squared)), std::numeric_limits<float>::max());
  return true;
}

// Builds a search and measures its queries. `build` returns the memory of its result in MiB.
template <class Build, class Nearest>
Measured measure(const std::vector<std::vector<glm::vec3>>& sets, Build build, Nearest nearest) {
  Measured measured;
  const double start = now_ms(), cpu = cpu_seconds();
  measured.mib = build();
  measured.build_ms = now_ms() - start;
  measured.build_cpu_ms = (cpu_seconds() - cpu) * 1000;
  for (const auto& points : sets) {
    const double before = cpu_seconds();
    for (const glm::vec3& point : points) measured.distances.push_back(nearest(point));
    measured.query_us.push_back((cpu_seconds() - before) * 1e6 / double(points.size()));
  }
  return measured;
}

Measured measure_own(const std::shared_ptr<const mesh::Geometry>& geometry,
                     const std::vector<std::vector<glm::vec3>>& sets) {
  std::unique_ptr<mesh::SearchTree> tree;
  return measure(
      sets,
      [&] {
        const double before = allocated_mib();
        tree = std::make_unique<mesh::SearchTree>(geometry);
        return allocated_mib() - before;
      },
      [&](const glm::vec3& point) {
        return tree->nearest(point, std::numeric_limits<float>::max())->distance;
      });
}

bool count_bytes(void* sum, ssize_t bytes, bool) {
  *static_cast<std::atomic<std::int64_t>*>(sum) += bytes;
  return true;
}

Measured measure_embree(const mesh::Geometry& geometry,
                        const std::vector<std::vector<glm::vec3>>& sets, RTCSceneFlags flags,
                        RTCBuildQuality quality) {
  std::atomic<std::int64_t> bytes = 0;
  const RTCDevice device = rtcNewDevice(nullptr);
  rtcSetDeviceMemoryMonitorFunction(device, count_bytes, &bytes);
  const RTCScene scene = rtcNewScene(device);
  Measured measured = measure(
      sets,
      [&] {
        rtcSetSceneFlags(scene, flags);
        rtcSetSceneBuildQuality(scene, quality);
        const RTCGeometry triangles = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        rtcSetSharedGeometryBuffer(triangles, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                   geometry.vertices.data(), offsetof(mesh::Vertex, position),
                                   sizeof(mesh::Vertex), geometry.vertices.size());
        rtcSetSharedGeometryBuffer(triangles, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                   geometry.indices.data(), 0, 3 * sizeof(std::uint32_t),
                                   geometry.triangle_count());
        rtcCommitGeometry(triangles);
        rtcAttachGeometry(scene, triangles);
        rtcReleaseGeometry(triangles);
        rtcCommitScene(scene);
        return static_cast<double>(bytes) / (1 << 20);
      },
      [&](const glm::vec3& point) {
        EmbreeQuery answer{geometry, point};
        RTCPointQuery query{point.x, point.y, point.z, 0, std::numeric_limits<float>::infinity()};
        RTCPointQueryContext context;
        rtcInitPointQueryContext(&context);
        rtcPointQuery(scene, &query, &context, visit_triangle, &answer);
        return static_cast<float>(std::sqrt(answer.squared));
      });
  rtcReleaseScene(scene);
  rtcReleaseDevice(device);
  return measured;
}

int run(const Options& options) {
  const BenchMesh mesh = must(load_bench_mesh(options.model, {options.cache}));
  const auto sets = point_sets(*mesh.geometry, options.points);
  std::printf("%s: %zu triangles, %d points of each kind\n", options.model.c_str(),
              mesh.geometry->triangle_count(), options.points);
  struct Method {
    const char* name;
    std::function<Measured()> measure;
  };
  const auto embree = [&](RTCSceneFlags flags, RTCBuildQuality quality) {
    return [&, flags, quality] { return measure_embree(*mesh.geometry, sets, flags, quality); };
  };
  const Method own{"own tree", [&] { return measure_own(mesh.geometry, sets); }};
  const Method methods[] = {
      own,
      {"Embree", embree(RTC_SCENE_FLAG_ROBUST, RTC_BUILD_QUALITY_MEDIUM)},
      {"Embree, compact",
       embree(static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_COMPACT),
              RTC_BUILD_QUALITY_MEDIUM)},
      {"Embree, quick build", embree(RTC_SCENE_FLAG_ROBUST, RTC_BUILD_QUALITY_LOW)},
      own};  // twice, to show the effect of other work on the machine
  nlohmann::json results = nlohmann::json::array();
  std::vector<float> expected;
  for (const auto& [name, make] : methods) {
    const Measured measured = make();
    if (expected.empty()) expected = measured.distances;
    float worst = 0;
    for (std::size_t i = 0; i < expected.size(); ++i)
      worst = std::max(worst, std::abs(measured.distances[i] - expected[i]));
    std::printf("%-20s build %7.1f ms (%7.1f ms of processor) %6.1f MiB;", name, measured.build_ms,
                measured.build_cpu_ms, measured.mib);
    nlohmann::json queries;
    for (std::size_t i = 0; i < sets.size(); ++i) {
      std::printf(" %s %.2f us", kSets[i], measured.query_us[i]);
      queries[kSets[i]] = measured.query_us[i];
    }
    std::printf("; differs by at most %g\n", double{worst});
    std::fflush(stdout);
    results.push_back({{"method", name},
                       {"model", options.model},
                       {"triangles", mesh.geometry->triangle_count()},
                       {"build_ms", measured.build_ms},
                       {"build_cpu_ms", measured.build_cpu_ms},
                       {"mib", measured.mib},
                       {"query_us", queries},
                       {"largest_difference", worst}});
  }
  write_result(options.json, machine(nullptr), results);
  return 0;
}

}  // namespace

Command add_nearest(CLI::App& app) {
  auto* command = app.add_subcommand(
      "nearest", "Nearest point of the surface: our search tree beside the point query of Embree");
  auto options = std::make_shared<Options>();
  command
      ->add_option("--model", options->model,
                   "vessel, excavation, amazon, thai, textured10m, or a file")
      ->capture_default_str();
  command->add_option("--points", options->points, "Points of each kind")->capture_default_str();
  command->add_option("--cache", options->cache, "Where generated meshes are kept")
      ->capture_default_str();
  command->add_option("--json", options->json, "Write the results here");
  return [options] { return run(*options); };
}

}  // namespace strata::bench
