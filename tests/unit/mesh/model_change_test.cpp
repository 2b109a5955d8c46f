// M3C2 between surfaces whose distance is known.
#include "mesh/analysis/model_change.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>

#include "mesh/atlas/atlas.h"
#include "mesh/surface/surface_normals.h"
#include "support/meshes.h"

namespace strata::mesh {
namespace {

std::shared_ptr<const Geometry> geometry_of(const TriangleMesh& mesh) {
  return std::make_shared<const Geometry>(build_geometry(mesh, Atlas{}));
}

// Moves every vertex by normally distributed noise along each axis.
TriangleMesh noisy(TriangleMesh mesh, double sigma, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0, sigma);
  for (auto& p : mesh.positions) p += glm::dvec3(noise(random), noise(random), noise(random));
  return mesh;
}

// Returns heights over the unit square.
template <class Height>
TriangleMesh sheet(int cells, Height height) {
  TriangleMesh mesh = test::open_grid(cells, 0);
  mesh.corner_uvs.clear();
  for (auto& p : mesh.positions) p.z = height(p.x, p.y);
  return mesh;
}
TriangleMesh plane(int cells, double height) {
  return sheet(cells, [=](double, double) { return height; });
}

bool is_inside(const glm::dvec3& p, double margin) {
  return std::min({p.x, 1 - p.x, p.y, 1 - p.y}) > margin;
}

// Calls visit(world position, change) for every `step`th vertex of `here`.
template <class Visit>
void measure(const TriangleMesh& here, const TriangleMesh& there, const ChangeScales& scales,
             Visit visit, std::uint32_t step = 1) {
  const auto a = geometry_of(here), b = geometry_of(there);
  Progress progress;
  const auto change = ModelChange::make(*a, 1, *b, 1, scales, progress);
  ASSERT_TRUE(change);
  const SurfaceNormals normals(a);
  for (std::uint32_t i = 0; i < a->positions.size(); i += step)
    visit(a->positions[i],
          change->at(glm::vec3(a->positions[i] - a->origin), normals.at_position(i)));
}

// Returns the share of the points whose distance is larger than the level of detection.
template <class Counts>
double significant_share(const TriangleMesh& here, const TriangleMesh& there,
                         const ChangeScales& scales, Counts counts) {
  int significant = 0, all = 0;
  measure(
      here, there, scales,
      [&](const glm::dvec3& p, const auto& change) {
        if (!change || !counts(p)) return;
        ++all;
        significant += std::abs(change->distance) > change->detection;
      },
      7);
  EXPECT_GT(all, 1000);
  return significant / static_cast<double>(all);
}

TEST(ModelChange, of_two_parallel_planes_is_their_offset_everywhere) {
  for (const int cells : {1, 7, 100})
    for (const double offset : {0.03, -0.011, 0.0}) {
      int count = 0;
      measure(plane(100, 1 + offset), plane(cells, 1), {0.1, 0.1, 0.2, 0},
              [&](const glm::dvec3&, const auto& change) {
                ASSERT_TRUE(change);
                EXPECT_NEAR(change->distance, offset, 1e-6) << cells;
                EXPECT_LT(change->detection, 1e-5) << cells;
                EXPECT_EQ(std::abs(change->distance) > change->detection, offset != 0) << cells;
                ++count;
              });
      EXPECT_EQ(count, 101 * 101);
    }
}

TEST(ModelChange, of_a_tilted_plane_is_measured_along_the_normal_of_this_surface) {
  const double slope = 0.2;
  measure(plane(100, 0.3), sheet(80, [=](double x, double) { return slope * x; }),
          {0.1, 0.1, 0.5, 0}, [&](const glm::dvec3& p, const auto& change) {
            if (!is_inside(p, 0.06)) return;
            ASSERT_TRUE(change);
            EXPECT_NEAR(change->distance, 0.3 - slope * p.x, 0.002);
            // A disc of radius r with the slope s has the variance (s r / 2)².
            EXPECT_GT(change->detection, 1.96 * slope * 0.05 / 2 / std::sqrt(80.0));
          });
}

TEST(ModelChange, of_two_balls_is_the_difference_of_their_radii) {
  const auto ball = [](double radius) { return test::transformed(test::sphere(200), radius, {}); };
  for (const double radius : {1.02, 0.97})
    measure(ball(radius), ball(1), {0.2, 0.1, 0.3, 0}, [&](const glm::dvec3&, const auto& change) {
      ASSERT_TRUE(change);
      EXPECT_NEAR(change->distance, radius - 1, 0.0005);
    });
}

constexpr double kSigma = 0.001;  // a quarter of an edge of the sheets
constexpr ChangeScales kSheetScales{0.12, 0.06, 0.2, 0};

double hills(double x, double y) { return 0.05 * std::sin(7 * x) * std::cos(5 * y); }

TEST(ModelChange, does_not_report_noise_as_change) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    const double share = significant_share(noisy(sheet(240, hills), kSigma, seed),
                                           noisy(sheet(230, hills), kSigma, seed + 100),
                                           kSheetScales, [](const glm::dvec3&) { return true; });
    EXPECT_LT(share, 0.05) << seed;
  }
}

TEST(ModelChange, does_not_report_noise_as_change_on_curved_and_unevenly_cut_surfaces) {
  // near the poles, the noise is larger than the triangles
  const auto counts = [](const glm::dvec3& p) { return std::abs(p.z) < 0.95 * glm::length(p); };
  const auto share = [&](int here, int there, double projection) {
    return significant_share(noisy(test::sphere(here), 0.003, 1),
                             noisy(test::sphere(there), 0.003, 2),
                             {2 * projection, projection, 0.6, 0}, counts);
  };
  EXPECT_LT(share(200, 170, 0.25), 0.05);
  EXPECT_LT(share(200, 100, 0.4), 0.05);  // a quarter of the vertices of the other scan
  EXPECT_LT(share(300, 290, 0.6), 0.05);  // many vertices in each cell of the samples
}

// Returns the number of vertices of a sheet in a cylinder.
double vertices_in_cylinder(double projection, int cells) {
  return std::numbers::pi / 4 * projection * projection * cells * cells;
}

TEST(ModelChange, finds_an_offset_of_three_times_the_level_of_detection) {
  const int cells_now = 240, cells_then = 230;
  const double offset = 3 * 1.96 * kSigma *
                        std::sqrt(1 / vertices_in_cylinder(kSheetScales.projection, cells_now) +
                                  1 / vertices_in_cylinder(kSheetScales.projection, cells_then));
  const auto now = [&](double x, double y) { return hills(x, y) + offset; };
  const double share = significant_share(noisy(sheet(cells_now, now), kSigma, 8),
                                         noisy(sheet(cells_then, hills), kSigma, 7), kSheetScales,
                                         [](const glm::dvec3& p) { return is_inside(p, 0.07); });
  EXPECT_GT(share, 0.99);
}

TEST(ModelChange, has_the_level_of_detection_of_independent_points) {
  // The edges are longer than a tenth of the cylinder's diameter, so each vertex is one point.
  const ChangeScales scales{0.16, 0.08, 0.2, 0};
  for (const double sigma_then : {0.001, 0.0003}) {
    const int cells_now = 100, cells_then = 115;
    const double sigma_now = 0.001;
    const double expected =
        1.96 *
        std::sqrt(sigma_now * sigma_now / vertices_in_cylinder(scales.projection, cells_now) +
                  sigma_then * sigma_then / vertices_in_cylinder(scales.projection, cells_then));
    double sum = 0;
    int count = 0;
    measure(noisy(plane(cells_now, 0), sigma_now, 1), noisy(plane(cells_then, 0), sigma_then, 2),
            scales, [&](const glm::dvec3& p, const auto& change) {
              if (!is_inside(p, 0.1)) return;
              ASSERT_TRUE(change);
              sum += change->detection;
              ++count;
            });
    EXPECT_GT(count, 5000);
    EXPECT_NEAR(sum / count / expected, 1, 0.1) << sigma_then;
  }
}

// Returns small separate triangles within 0.035 of a point. Each of them counts as half a vertex.
// Half of them are above the point, and half below it.
TriangleMesh pairs_of_triangles(int pairs, const glm::dvec3& around, double height) {
  TriangleMesh mesh;
  for (int i = 0; i < 2 * pairs; ++i) {
    const int column = i % 5 - 2, row = i / 5 - 2;
    const glm::dvec3 p =
        around + glm::dvec3(0.012 * column, 0.012 * row, i % 2 == 0 ? height : -height);
    for (const glm::dvec3& corner : {p, p + glm::dvec3(0.001, 0, 0), p + glm::dvec3(0, 0.001, 0)}) {
      mesh.triangles.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
      mesh.positions.push_back(corner);
    }
  }
  return mesh;
}

TEST(ModelChange, has_the_level_of_detection_of_students_distribution_for_few_points) {
  // 97.5 % quantiles for 1, 2, 3, … degrees of freedom
  constexpr std::array kQuantiles{12.706, 4.303, 3.182, 2.776, 2.571,
                                  2.447,  2.365, 2.306, 2.262, 2.228};
  const glm::dvec3 middle(0.5, 0.5, 0);
  const auto here = geometry_of(plane(100, 0));
  for (std::size_t i = 0; i < kQuantiles.size(); ++i) {
    const int degrees = static_cast<int>(i) + 1;
    const auto there = geometry_of(pairs_of_triangles(degrees + 1, middle, 0.002));
    Progress progress;
    const auto made = ModelChange::make(*here, 1, *there, 1, {0.1, 0.1, 0.2, 0}, progress);
    ASSERT_TRUE(made);
    const auto change = made->at(glm::vec3(middle - here->origin), {0, 0, 1});
    ASSERT_TRUE(change) << degrees;
    EXPECT_NEAR(change->distance, 0, 1e-5);
    const double expected = kQuantiles[i] * 0.002 / std::sqrt(degrees);
    EXPECT_NEAR(change->detection / expected, 1, 0.01) << degrees;
  }
}

TEST(ModelChange, is_found_many_diameters_away) {
  for (const double offset : {0.37, -0.41, 0.083})
    measure(
        plane(50, 1 + offset), plane(150, 1), {0.08, 0.02, 0.42, 0},
        [&](const glm::dvec3& p, const auto& change) {
          if (!is_inside(p, 0.02)) return;
          ASSERT_TRUE(change);
          EXPECT_NEAR(change->distance, offset, 1e-6);
        },
        13);
  // The other surface is a slope. It passes the limit of the search at x = 0.5.
  measure(
      plane(50, 0), sheet(150, [](double x, double) { return x; }), {0.08, 0.02, 0.5, 0},
      [](const glm::dvec3& p, const auto& change) {
        if (!is_inside(p, 0.02) || std::abs(p.x - 0.5) < 0.03) return;
        EXPECT_EQ(change.has_value(), p.x < 0.5) << p.x;
        if (change) {
          EXPECT_NEAR(change->distance, -p.x, 0.003);
        }
      },
      13);
}

TEST(ModelChange, adds_the_error_of_the_registration) {
  const auto detection = [](double registration) {
    std::optional<double> found;
    measure(plane(60, 0.02), plane(60, 0), {0.2, 0.1, 0.2, registration},
            [&](const glm::dvec3&, const auto& change) { found = change->detection; });
    return found.value_or(-1);
  };
  EXPECT_NEAR(detection(0.01), 1.96 * 0.01, 1e-5);
  EXPECT_LT(detection(0.01), 0.02);
  EXPECT_GT(detection(0.011), 0.02);
}

TEST(ModelChange, is_none_where_the_other_surface_is_too_far_away_or_missing) {
  measure(plane(40, 0.3), plane(40, 0), {0.2, 0.1, 0.25, 0},
          [](const glm::dvec3&, const auto& change) { EXPECT_FALSE(change); });
  TriangleMesh half = plane(40, 0);
  for (auto& p : half.positions) p.x *= 0.5;
  measure(plane(40, 0.05), half, {0.2, 0.1, 0.25, 0}, [](const glm::dvec3& p, const auto& change) {
    if (p.x > 0.49 && p.x < 0.56) return;  // the cylinder contains the border
    EXPECT_EQ(change.has_value(), p.x < 0.5) << p.x;
  });
}

TEST(ModelChange, of_a_thin_wall_is_not_disturbed_by_its_other_side_or_by_a_farther_fold) {
  TriangleMesh wall = plane(60, 0);
  const auto append = [&](double height, bool faces_down) {
    const TriangleMesh more = plane(60, height);
    const auto first = static_cast<std::uint32_t>(wall.positions.size());
    wall.positions.insert(wall.positions.end(), more.positions.begin(), more.positions.end());
    for (std::size_t i = 0; i < more.triangles.size(); i += 3)
      for (const std::size_t k : {0, faces_down ? 2 : 1, faces_down ? 1 : 2})
        wall.triangles.push_back(more.triangles[i + k] + first);
  };
  append(-0.01, true);   // the other side
  append(-0.25, false);  // another surface that faces the same way
  measure(plane(60, 0.02), wall, {0.2, 0.1, 0.4, 0}, [](const glm::dvec3&, const auto& change) {
    ASSERT_TRUE(change);
    EXPECT_NEAR(change->distance, 0.02, 1e-6);
  });
}

TEST(ModelChange, has_the_unit_of_this_model) {
  const auto here = geometry_of(test::transformed(plane(60, 0.03), 1000, {4000, 0, 0}));
  const auto there = geometry_of(test::transformed(plane(60, 0), 1, {4, 0, 0}));
  Progress progress;
  const auto change = ModelChange::make(*here, 0.001, *there, 1, {200, 100, 200, 2}, progress);
  ASSERT_TRUE(change);
  for (const auto& p : here->positions) {
    const auto found = change->at(glm::vec3(p - here->origin), {0, 0, 1});
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->distance, 30, 1e-3);
    EXPECT_NEAR(found->detection, 3.92, 1e-2);
  }
}

TEST(ModelChange, can_be_cancelled) {
  Progress progress;
  progress.cancel();
  const auto geometry = geometry_of(plane(20, 0));
  const auto cancelled = ModelChange::make(*geometry, 1, *geometry, 1, {0.2, 0.1, 1, 0}, progress);
  ASSERT_FALSE(cancelled);
  EXPECT_EQ(cancelled.error().code, ErrorCode::cancelled);
}

}  // namespace
}  // namespace strata::mesh
