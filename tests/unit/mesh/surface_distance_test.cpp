// Distances along shapes with known distances, with atlases that are cut in different ways.
#include "mesh/distance/surface_distance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <numbers>
#include <queue>

#include "core/progress.h"
#include "mesh/texels/texel_owners.h"
#include "strata_dirs.h"
#include "support/cut_shapes.h"
#include "support/meshes.h"
#include "support/scan_atlas.h"

namespace strata::mesh {
namespace {

using test::Cuts;
using test::Shape;
using test::Surface;
using Sources = std::vector<std::uint64_t>;
constexpr double kPi = std::numbers::pi;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kResolution = 512;
constexpr Cuts kCuts[] = {{1, 1, 0.4, 1}, {3, 3, 0.7, 0.75}, {4, 5, 1.1, 0.5}, {7, 7, 0.3, 0.9}};

glm::dvec3 place(const Surface& surface, std::uint32_t texel) {
  return surface.geometry.origin +
         glm::dvec3(surface.map.position(texel / 64, static_cast<int>(texel % 64)));
}

double texel_side(const Surface& surface) {
  return std::sqrt(surface.map.area_total / double(surface.map.surface_texels));
}

Sources sources_where(const Surface& surface, const std::function<bool(glm::dvec3)>& is_source) {
  Sources sources(surface.map.block_of_slot.size(), 0);
  test::for_each_surface_texel(surface.map, [&](std::uint32_t texel) {
    if (is_source(place(surface, texel))) sources[texel / 64] |= std::uint64_t{1} << texel % 64;
  });
  return sources;
}

std::uint32_t texel_at(const Surface& surface, const glm::dvec3& position) {
  std::uint32_t nearest = kNoNeighbour;
  double least = kInfinity;
  test::for_each_surface_texel(surface.map, [&](std::uint32_t texel) {
    const double distance = glm::distance(place(surface, texel), position);
    if (distance < least) least = distance, nearest = texel;
  });
  return nearest;
}

Sources only(const Surface& surface, std::initializer_list<std::uint32_t> texels) {
  Sources sources(surface.map.block_of_slot.size(), 0);
  for (const std::uint32_t texel : texels) sources[texel / 64] |= std::uint64_t{1} << texel % 64;
  return sources;
}

SurfaceDistances measure(const Surface& surface, const Sources& sources, double limit = kInfinity,
                         int threads = 2) {
  Progress progress;
  auto distances =
      distances_along_surface(surface.map, surface.graph, sources, limit, progress, threads);
  EXPECT_TRUE(distances);
  return std::move(*distances);
}

// Texels near the source are compared by texels, because the source is a texel too.
void expect_distances(const Surface& surface, const SurfaceDistances& distances,
                      const std::function<double(glm::dvec3)>& expected, double share,
                      double texels) {
  const double side = texel_side(surface);
  double worst = 0;
  glm::dvec3 where(0);
  test::for_each_surface_texel(surface.map, [&](std::uint32_t texel) {
    const double right = expected(place(surface, texel));
    if (right < 0) return;  // no formula there
    const double error =
        std::abs(double{distances.at(texel)} - right) / std::max(share * right, texels * side);
    if (!(error <= worst)) worst = error, where = place(surface, texel);
  });
  EXPECT_LE(worst, 1) << "at " << where.x << ", " << where.y << ", " << where.z << ": "
                      << distances.at(texel_at(surface, where)) << " instead of "
                      << expected(where);
}

double angle_between(double a, double b) {
  const double angle = std::abs(a - b);
  return std::min(angle, 2 * kPi - angle);
}

Shape sheet() {
  return {64, 64, [](double s, double t) { return glm::dvec3(s, t, 0); },
          [](double s, double t) { return glm::dvec2(s, t); }};
}

Shape cone(double slant) {
  return {256, 64,
          [=](double s, double t) {
            const double r = 2 * t, angle = 2 * kPi * s;
            return glm::dvec3(r * std::sin(slant) * std::cos(angle),
                              r * std::sin(slant) * std::sin(angle), -r * std::cos(slant));
          },
          [=](double s, double t) {
            const double angle = 2 * kPi * s * std::sin(slant);
            return 2 * t * glm::dvec2(std::cos(angle), std::sin(angle));
          }};
}

class SurfaceDistance : public testing::TestWithParam<Cuts> {};
INSTANTIATE_TEST_SUITE_P(cut, SurfaceDistance, testing::ValuesIn(kCuts));

TEST_P(SurfaceDistance, from_a_point_of_a_plane_is_straight) {
  const Surface surface = test::cut_surface(sheet(), GetParam(), kResolution);
  const std::uint32_t source = texel_at(surface, {0.3, 0.4, 0});
  const glm::dvec3 from = place(surface, source);
  expect_distances(
      surface, measure(surface, only(surface, {source})),
      [&](glm::dvec3 p) { return glm::distance(p, from); }, 0.01, 1.5);
}

TEST_P(SurfaceDistance, from_a_painted_area_begins_at_its_border) {
  const Surface surface = test::cut_surface(sheet(), GetParam(), kResolution);
  const auto is_source = [](glm::dvec3 p) { return std::hypot(p.x - 0.5, p.y - 0.4) < 0.1; };
  const auto distances = measure(surface, sources_where(surface, is_source));
  expect_distances(
      surface, distances,
      [](glm::dvec3 p) { return std::max(0.0, std::hypot(p.x - 0.5, p.y - 0.4) - 0.1); }, 0.01, 2);
  test::for_each_surface_texel(surface.map, [&](std::uint32_t texel) {
    ASSERT_EQ(distances.at(texel) == 0, is_source(place(surface, texel)));
  });
}

TEST_P(SurfaceDistance, from_a_line_is_the_same_in_every_direction) {
  const Surface surface = test::cut_surface(sheet(), GetParam(), kResolution);
  for (const double degrees : {0.0, 20.0, 45.0, 77.0}) {
    SCOPED_TRACE(degrees);
    const double x = std::cos(degrees * kPi / 180), y = std::sin(degrees * kPi / 180);
    const auto beyond = [=](glm::dvec3 p) { return x * (p.x - 0.5) + y * (p.y - 0.5) + 0.2; };
    expect_distances(
        surface, measure(surface, sources_where(surface, [&](auto p) { return beyond(p) < 0; })),
        [&](glm::dvec3 p) {
          const double along = y * (p.x - 0.5) - x * (p.y - 0.5);
          return std::abs(along) > 0.2 ? -1 : std::max(0.0, beyond(p));
        },
        0.01, 2);
  }
}

TEST_P(SurfaceDistance, winds_around_a_cylinder) {
  const Shape cylinder{256, 64,
                       [](double s, double t) {
                         return glm::dvec3(std::cos(2 * kPi * s), std::sin(2 * kPi * s), 3 * t);
                       },
                       [](double s, double t) { return glm::dvec2(2 * kPi * s, 3 * t); }};
  const Surface surface = test::cut_surface(cylinder, GetParam(), kResolution);
  const std::uint32_t source = texel_at(surface, {-1, 0, 1});
  const glm::dvec3 from = place(surface, source);
  expect_distances(
      surface, measure(surface, only(surface, {source})),
      [&](glm::dvec3 p) {
        return std::hypot(angle_between(std::atan2(p.y, p.x), std::atan2(from.y, from.x)),
                          p.z - from.z);
      },
      0.01, 1.5);
}

TEST_P(SurfaceDistance, goes_around_and_over_the_tip_of_a_cone) {
  for (const double slant : {0.3, 0.5, 1.2}) {
    SCOPED_TRACE(slant);
    const Surface surface = test::cut_surface(cone(slant), GetParam(), kResolution);
    const std::uint32_t source = texel_at(surface, {-std::sin(slant), 0, -std::cos(slant)});
    const glm::dvec3 from = place(surface, source);
    expect_distances(
        surface, measure(surface, only(surface, {source})),
        [&](glm::dvec3 p) {
          const double r = glm::length(p), from_r = glm::length(from);
          const double angle =
              std::sin(slant) * angle_between(std::atan2(p.y, p.x), std::atan2(from.y, from.x));
          if (angle >= kPi) return r + from_r;
          return std::sqrt(
              std::max(0.0, r * r + from_r * from_r - 2 * r * from_r * std::cos(angle)));
        },
        0.01, 1.5);
  }
}

TEST(SurfaceDistance, is_the_angle_on_a_sphere_wherever_its_seams_are) {
  for (const int segments : {96, 128, 160}) {  // three atlases
    SCOPED_TRACE(segments);
    const Surface surface = test::surface_of("sphere", test::sphere(segments), kResolution);
    for (const glm::dvec3 towards : {glm::dvec3(-0.6, 0.3, 0.5), glm::dvec3(0, 0.1, -1)}) {
      const std::uint32_t source = texel_at(surface, glm::normalize(towards));
      const glm::dvec3 from = glm::normalize(place(surface, source));
      expect_distances(
          surface, measure(surface, only(surface, {source})),
          [&](glm::dvec3 p) {
            p = glm::normalize(p);
            return std::atan2(glm::length(glm::cross(p, from)), glm::dot(p, from));
          },
          0.01, 1.5);
    }
  }
}

TEST(SurfaceDistance, is_the_same_on_texels_that_are_stretched_or_sheared) {
  Shape shape = sheet();
  for (const glm::dmat2 flat : {glm::dmat2(4, 0, 0, 1), glm::dmat2(1, 0, 0, 3),
                                glm::dmat2(1, 0, 0.7, 1), glm::dmat2(1, 0, -1, 1)}) {
    shape.flat = [=](double s, double t) { return flat * glm::dvec2(s, t); };
    const Surface surface = test::cut_surface(shape, Cuts{2, 2}, kResolution);
    const std::uint32_t source = texel_at(surface, {0.6, 0.3, 0});
    const glm::dvec3 from = place(surface, source);
    expect_distances(
        surface, measure(surface, only(surface, {source})),
        [&](glm::dvec3 p) { return glm::distance(p, from); }, 0.03, 2);
  }
}

// The worst and the mean error beyond 20 texels, as shares of the distance from a point.
struct Errors {
  double worst = 0, mean = 0;
};

Errors errors_from_a_point(const Surface& surface) {
  const std::uint32_t source = texel_at(surface, {0.5, 0.5, 0});
  const glm::dvec3 from = place(surface, source);
  const auto distances = measure(surface, only(surface, {source}));
  const double side = texel_side(surface);
  Errors errors;
  double count = 0;
  test::for_each_surface_texel(surface.map, [&](std::uint32_t texel) {
    const double right = glm::distance(place(surface, texel), from);
    if (right < 20 * side) return;
    const double error = std::abs(double{distances.at(texel)} - right) / right;
    errors.worst = std::max(errors.worst, error);
    errors.mean += error;
    ++count;
  });
  errors.mean /= count;
  return errors;
}

TEST_P(SurfaceDistance, from_a_point_is_exact_in_the_mean) {
  const Errors errors = errors_from_a_point(test::cut_surface(sheet(), GetParam(), kResolution));
  EXPECT_LT(errors.worst, 0.01);
  EXPECT_LT(errors.mean, 0.0005);
}

struct Stretched {
  const char* name;
  glm::dmat2 flat;
  double worst, mean;
};

glm::dmat2 stretched(double ratio, double degrees) {
  const double x = std::cos(degrees * kPi / 180), y = std::sin(degrees * kPi / 180);
  return glm::dmat2(x, y, -y, x) * glm::dmat2(ratio, 0, 0, 1);
}

// The eight neighbors of a texel suffice along its rows and diagonals. The errors are greatest
// between them.
TEST(SurfaceDistance, has_errors_that_grow_with_the_stretch_of_a_chart) {
  for (const Stretched& each : {Stretched{"2 at 15°", stretched(2, 15), 0.001, 0.0001},
                                Stretched{"2 at 30°", stretched(2, 30), 0.001, 0.0001},
                                Stretched{"3 at 15°", stretched(3, 15), 0.01, 0.001},
                                Stretched{"3 at 30°", stretched(3, 30), 0.01, 0.001},
                                Stretched{"4 at 15°", stretched(4, 15), 0.02, 0.0025},
                                Stretched{"4 at 30°", stretched(4, 30), 0.02, 0.0025},
                                Stretched{"6 at 15°", stretched(6, 15), 0.04, 0.01},
                                Stretched{"6 at 30°", stretched(6, 30), 0.04, 0.01},
                                Stretched{"sheared by 2", glm::dmat2(1, 0, 2, 1), 0.1, 0.02},
                                Stretched{"sheared by -2", glm::dmat2(1, 0, -2, 1), 0.1, 0.02}}) {
    SCOPED_TRACE(each.name);
    Shape shape = sheet();
    shape.flat = [&](double s, double t) { return each.flat * glm::dvec2(s, t); };
    const Errors errors = errors_from_a_point(test::cut_surface(shape, Cuts{1, 1}, kResolution));
    EXPECT_LT(errors.worst, each.worst);
    EXPECT_LT(errors.mean, each.mean);
  }
}

TEST(SurfaceDistance, names_the_nearest_of_several_sources) {
  const Surface surface = test::cut_surface(sheet(), kCuts[1], kResolution);
  const std::vector<std::uint32_t> sources{texel_at(surface, {0.2, 0.3, 0}),
                                           texel_at(surface, {0.7, 0.8, 0}),
                                           texel_at(surface, {0.8, 0.2, 0})};
  const auto distances = measure(surface, only(surface, {sources[0], sources[1], sources[2]}));
  const double side = texel_side(surface);
  test::for_each_surface_texel(surface.map, [&](std::uint32_t texel) {
    const std::uint32_t found = distances.source_of(texel);
    ASSERT_NE(std::ranges::find(sources, found), sources.end());
    double least = kInfinity;
    for (const std::uint32_t source : sources)
      least = std::min(least, glm::distance(place(surface, texel), place(surface, source)));
    ASSERT_LE(glm::distance(place(surface, texel), place(surface, found)), least + 2 * side);
  });
}

TEST(SurfaceDistance, up_to_a_limit_is_the_same_as_without_one) {
  const Surface surface = test::surface_of("torus", test::torus(96), kResolution);
  const Sources sources = sources_where(surface, [](glm::dvec3 p) { return p.x > 1.2; });
  const auto all = measure(surface, sources), band = measure(surface, sources, 0.5),
             none = measure(surface, sources, 0), one_thread = measure(surface, sources, 0.5, 1);
  EXPECT_LT(band.bytes(), all.bytes());
  std::uint64_t reached = 0;
  test::for_each_surface_texel(surface.map, [&](std::uint32_t texel) {
    ASSERT_LT(all.at(texel), kInfinity) << "the whole surface is connected";
    ASSERT_EQ(none.at(texel) < kInfinity, none.is_source(texel));
    ASSERT_EQ(band.at(texel), one_thread.at(texel));
    ASSERT_EQ(band.source_of(texel), one_thread.source_of(texel));
    const bool within = band.at(texel) < kInfinity;
    ASSERT_EQ((band.reached_in(texel / 64) >> texel % 64 & 1u) != 0, within);
    ASSERT_EQ(band.source_of(texel) != kNoNeighbour, within);
    reached += within;
    // The order of the blocks may differ, so paths of almost the same length may too.
    if (within) {
      ASSERT_NEAR(band.at(texel), all.at(texel), 0.05 * texel_side(surface));
    } else {
      ASSERT_GT(all.at(texel), 0.5 - 0.05 * texel_side(surface));
    }
  });
  EXPECT_EQ(band.reached_texels(), reached);
}

TEST(SurfaceDistance, without_sources_reaches_nothing) {
  const Surface surface = test::surface_of("torus", test::torus(32), 256);
  const auto distances = measure(surface, Sources(surface.map.block_of_slot.size(), 0));
  EXPECT_EQ(distances.reached_texels(), 0);
  test::for_each_surface_texel(surface.map, [&](std::uint32_t texel) {
    ASSERT_EQ(distances.at(texel), kInfinity);
    ASSERT_EQ(distances.source_of(texel), kNoNeighbour);
  });
}

TEST(SurfaceDistance, does_not_leave_a_piece_of_the_surface) {
  const Surface surface = test::surface_of("cubes", test::cubes(3), 256);
  std::uint32_t source = kNoNeighbour;
  test::for_each_surface_texel(surface.map, [&](std::uint32_t texel) { source = texel; });
  const auto distances = measure(surface, only(surface, {source}));
  EXPECT_GT(distances.reached_texels(), surface.map.surface_texels / 4);
  EXPECT_LT(distances.reached_texels(), surface.map.surface_texels / 2);
}

// Returns the lengths of the shortest paths over the connections of texels.
std::vector<double> path_lengths(const Surface& surface, std::uint32_t source) {
  std::vector<double> lengths(surface.map.block_of_slot.size() * 64, kInfinity);
  using Entry = std::pair<double, std::uint32_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  lengths[source] = 0;
  queue.emplace(0, source);
  while (!queue.empty()) {
    const auto [length, texel] = queue.top();
    queue.pop();
    if (length > lengths[texel]) continue;
    for_each_neighbour(surface.map, surface.graph, texel, [&](std::uint32_t next) {
      const double there = length + glm::distance(place(surface, texel), place(surface, next));
      if (there >= lengths[next]) return;
      lengths[next] = there;
      queue.emplace(there, next);
    });
  }
  return lengths;
}

TEST(SurfaceDistance, lies_between_the_straight_line_and_paths_over_texels) {
  for (const auto& [name, mesh] : test::mesh_classes()) {
    SCOPED_TRACE(name);
    const Surface surface = test::surface_of(name, mesh, 256);
    std::uint32_t source = kNoNeighbour;
    test::for_each_surface_texel(surface.map, [&](std::uint32_t texel) {
      if (source == kNoNeighbour) source = texel;
    });
    ASSERT_NE(source, kNoNeighbour);
    const auto distances = measure(surface, only(surface, {source}));
    const auto lengths = path_lengths(surface, source);
    const double side = texel_side(surface);
    test::for_each_surface_texel(surface.map, [&](std::uint32_t texel) {
      ASSERT_EQ(distances.at(texel) < kInfinity, lengths[texel] < kInfinity);
      if (lengths[texel] == kInfinity) return;
      ASSERT_LE(distances.at(texel), lengths[texel] * 1.0001 + 1e-4 * side);
      ASSERT_GE(distances.at(texel),
                glm::distance(place(surface, texel), place(surface, source)) * 0.99 - side);
    });
  }
}

TEST(SurfaceDistance, of_faces_without_area_is_finite) {
  TriangleMesh mesh = test::open_grid(16, 0);
  for (glm::dvec3& p : mesh.positions)
    if (p.x > 0.4 && p.x < 0.6) p.x = 0.5;  // two columns of faces become lines
  Atlas atlas;
  atlas.corner_uvs = mesh.corner_uvs;
  Progress progress;
  Surface surface;
  surface.geometry = build_geometry(mesh, atlas);
  surface.map = *bake_surface_map(surface.geometry, 256, progress);
  surface.graph = *build_texel_graph(surface.geometry, surface.map, progress);
  const std::uint32_t source = texel_at(surface, {0.1, 0.5, 0});
  const glm::dvec3 from = place(surface, source);
  expect_distances(
      surface, measure(surface, only(surface, {source})),
      [&](glm::dvec3 p) { return glm::distance(p, from); }, 0.03, 2);
}

// Shortest paths over the triangles of a mesh, through points on their edges. They are at most
// about 1 % longer than the exact distances.
class EdgePaths {
 public:
  EdgePaths(const Geometry& geometry, const glm::dvec3& source, std::uint32_t source_triangle)
      : geometry_(geometry), points_(geometry.triangle_count()) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> first_of_edge;
    for (std::uint32_t t = 0; t < geometry.triangle_count(); ++t)
      for (int k = 0; k < 3; ++k) {
        std::uint32_t a = corner(t, k), b = corner(t, (k + 1) % 3);
        if (a > b) std::swap(a, b);
        const auto [found, fresh] =
            first_of_edge.try_emplace({a, b}, static_cast<std::uint32_t>(place_.size()));
        for (std::uint32_t i = 0; i < kPerEdge; ++i) {
          if (fresh)
            place_.push_back(
                glm::mix(geometry.positions[a], geometry.positions[b], double(i) / (kPerEdge - 1)));
          points_[t].push_back(found->second + i);
        }
      }
    triangles_.resize(place_.size());
    for (std::uint32_t t = 0; t < points_.size(); ++t)
      for (const std::uint32_t point : points_[t]) triangles_[point].push_back(t);
    length_.assign(place_.size(), kInfinity);
    using Entry = std::pair<double, std::uint32_t>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    const auto reach = [&](std::uint32_t point, double length) {
      if (length >= length_[point]) return;
      length_[point] = length;
      queue.emplace(length, point);
    };
    for (const std::uint32_t point : points_[source_triangle])
      reach(point, glm::distance(place_[point], source));
    while (!queue.empty()) {
      const auto [length, point] = queue.top();
      queue.pop();
      if (length > length_[point]) continue;
      for (const std::uint32_t t : triangles_[point])
        for (const std::uint32_t next : points_[t])
          reach(next, length + glm::distance(place_[point], place_[next]));
    }
  }

  double to(const glm::dvec3& place, std::uint32_t triangle) const {
    double least = kInfinity;
    for (const std::uint32_t point : points_[triangle])
      least = std::min(least, length_[point] + glm::distance(place_[point], place));
    return least;
  }

 private:
  static constexpr std::uint32_t kPerEdge = 20;
  std::uint32_t corner(std::uint32_t t, int k) const {
    return geometry_.vertices[geometry_.indices[3 * std::size_t{t} + std::size_t(k)]]
        .position_index;
  }
  const Geometry& geometry_;
  std::vector<std::vector<std::uint32_t>> points_;     // of each triangle
  std::vector<std::vector<std::uint32_t>> triangles_;  // of each point
  std::vector<glm::dvec3> place_;
  std::vector<double> length_;
};

TEST(SurfaceDistance, on_a_scan_is_that_of_paths_over_its_triangles) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "takes minutes with sanitizers";
#endif
  const std::string name = "vessel_lekythos_gigamesh_15k.ply";
  if (!std::filesystem::exists(std::filesystem::path(STRATA_TEST_DATA) / name))
    GTEST_SKIP() << "NO SCAN at " << STRATA_TEST_DATA << ": distances on scans are not tested";
  const auto& scan = test::scan_with_made_atlas(name);
  ASSERT_TRUE(scan) << scan.error().detail;
  Progress progress;
  Surface surface;
  surface.geometry = build_geometry(scan->mesh, scan->atlas);
  surface.map = *bake_surface_map(surface.geometry, 2048, progress);
  surface.graph = *build_texel_graph(surface.geometry, surface.map, progress);
  const TexelOwners owners = *bake_texel_owners(surface.geometry, 2048, progress);
  const std::uint32_t source =
      texel_at(surface, surface.geometry.origin + glm::dvec3(surface.geometry.box_max));
  const EdgePaths exact(surface.geometry, place(surface, source), owners.triangle[source]);
  const auto distances = measure(surface, only(surface, {source}));
  const double side = texel_side(surface);
  // Near the source, and at sharp rims that a texel rounds off, an error is a matter of texels.
  std::size_t count = 0, wrong = 0;
  double sum = 0;
  test::for_each_surface_texel(surface.map, [&](std::uint32_t texel) {
    if (texel % 17 != 0) return;
    const double right = exact.to(place(surface, texel), owners.triangle[texel]);
    if (right < 20 * side || right == kInfinity) return;
    const double error = std::abs(distances.at(texel) - right);
    sum += error / right;
    ++count;
    wrong += error > std::max(0.02 * right, 1.5 * side);
  });
  ASSERT_GT(count, 5000);
  EXPECT_LT(sum / double(count), 0.01);
  EXPECT_LE(double(wrong), 0.002 * double(count));
}

TEST(SurfaceDistance, stops_when_cancelled_and_refuses_a_limit_that_is_no_distance) {
  const Surface surface = test::surface_of("torus", test::torus(32), 256);
  const Sources sources = sources_where(surface, [](glm::dvec3 p) { return p.x > 1.2; });
  Progress progress;
  for (const double limit : {-1.0, std::numeric_limits<double>::quiet_NaN()}) {
    const auto refused =
        distances_along_surface(surface.map, surface.graph, sources, limit, progress);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::malformed);
  }
  EXPECT_FALSE(distances_along_surface(surface.map, surface.graph, Sources(1), 1, progress));
  progress.cancel();
  const auto cancelled = distances_along_surface(surface.map, surface.graph, sources, 1, progress);
  ASSERT_FALSE(cancelled);
  EXPECT_EQ(cancelled.error().code, ErrorCode::cancelled);
}

}  // namespace
}  // namespace strata::mesh
