#include "mesh/atlas/flatten.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "mesh/atlas/chart_conflicts.h"
#include "mesh/atlas/relax.h"
#include "support/meshes.h"

namespace strata::mesh {
namespace {

// Returns six congruent triangles around point 0.
RelaxPatch hexagon() {
  RelaxPatch patch;
  patch.points.push_back({0, 0});
  for (int i = 0; i < 6; ++i)
    patch.points.push_back(
        {std::cos(float(M_PI) / 3 * float(i)), std::sin(float(M_PI) / 3 * float(i))});
  patch.is_fixed = {0, 1, 1, 1, 1, 1, 1};
  for (std::uint32_t i = 0; i < 6; ++i)
    patch.faces.push_back({{0, 1 + i, 1 + (i + 1) % 6}, {1, 0}, {0.5f, std::sqrt(3.f) / 2}});
  return patch;
}

TEST(mesh_relax, brings_a_point_that_folds_its_triangles_back_between_its_neighbours) {
  RelaxPatch patch = hexagon();
  patch.points[0] = {3, 1};  // far outside, so two triangles are flipped
  relax(patch, 0.99f, 100);
  EXPECT_NEAR(patch.points[0].x, 0, 0.02);
  EXPECT_NEAR(patch.points[0].y, 0, 0.02);
}

TEST(mesh_relax, leaves_fixed_points_where_they_are) {
  RelaxPatch patch = hexagon();
  patch.is_fixed[0] = 1;
  patch.points[0] = {0.5f, 0.25f};
  const auto before = patch.points;
  relax(patch, 0.99f, 100);
  EXPECT_EQ(patch.points, before);
}

TEST(mesh_relax, takes_triangles_without_a_true_shape) {
  RelaxPatch patch = hexagon();
  patch.faces[2].b = patch.faces[2].c = {0, 0};
  patch.faces[3].c = {2, 0};
  patch.points[0] = {0.9f, 0};
  relax(patch, 0.99f, 50);
  EXPECT_TRUE(std::isfinite(patch.points[0].x) && std::isfinite(patch.points[0].y));
  EXPECT_LT(glm::length(patch.points[0]), 1);
}

// Returns a sheet with a bump. Its flanks are so steep that they have almost no area in a view from
// above.
TriangleMesh steep_bump() {
  TriangleMesh mesh = test::open_grid(40, 0);
  for (auto& p : mesh.positions) {
    const glm::dvec3 middle(0.5, 0.5, 0);
    const double r = std::hypot(p.x - middle.x, p.y - middle.y);
    if (r < 0.12) p.z += 0.4 * (1 - r / 0.12);
  }
  return mesh;
}

class OneChart {
 public:
  explicit OneChart(const TriangleMesh& mesh)
      : unit(to_unit_mesh(mesh)), surface(make_chart_surface(unit, 0)), charts(1) {
    for (std::uint32_t f = 0; f < mesh.triangle_count(); ++f) charts[0].faces.push_back(f);
  }
  const UnitMesh unit;
  ChartSurface surface;
  std::vector<Chart> charts;
};

double area_in_plane(std::span<const glm::vec2> plane, std::size_t f) {
  const glm::dvec2 ab = plane[3 * f + 1] - plane[3 * f], ac = plane[3 * f + 2] - plane[3 * f];
  return (ab.x * ac.y - ab.y * ac.x) / 2;
}

TEST(mesh_flatten, gives_room_to_what_a_projection_squeezes) {
  const TriangleMesh mesh = steep_bump();
  const OneChart one(mesh);
  double least_projected = 1e9;
  for (std::uint32_t f = 0; f < mesh.triangle_count(); ++f) {
    glm::vec2 p[3];
    for (int k = 0; k < 3; ++k) p[k] = one.charts[0].project(one.unit.corner(f, k));
    least_projected =
        std::min(least_projected, area_in_plane(p, 0) / one.surface.original_frames.areas[f]);
  }
  ASSERT_LT(least_projected, 0.35);
  std::vector<glm::vec2> plane;
  flatten(one.surface, one.charts, 0, Progress{}, plane);
  double sum = 0;
  for (std::size_t f = 0; f < mesh.triangle_count(); ++f) {
    EXPECT_GT(area_in_plane(plane, f), 0) << f;
    EXPECT_GT(area_in_plane(plane, f),
              1.15 * least_projected * one.surface.original_frames.areas[f])
        << f;
    sum += area_in_plane(plane, f);
  }
  EXPECT_NEAR(sum / one.surface.original_frames.total_area, 1, 0.01);
}

TEST(mesh_flatten, names_the_faces_that_stay_squeezed) {
  const TriangleMesh mesh = steep_bump();
  const OneChart one(mesh);
  std::vector<glm::vec2> plane(3 * mesh.triangle_count());
  for (std::uint32_t f = 0; f < mesh.triangle_count(); ++f)
    for (int k = 0; k < 3; ++k) plane[3 * f + k] = one.charts[0].project(one.unit.corner(f, k));
  const auto faces = squeezed_faces(one.surface, plane, 2, 0);
  EXPECT_GT(faces.size(), 10u);
  for (const auto f : faces)
    EXPECT_LT(area_in_plane(plane, f), 0.501 * one.surface.original_frames.areas[f]);
  EXPECT_THAT(squeezed_faces(one.surface, plane, 2, 1), testing::IsEmpty()) << "none is so large";
}

TEST(mesh_flatten, does_not_depend_on_the_number_of_threads) {
  const auto mesh = test::sphere(60);
  const UnitMesh unit = to_unit_mesh(mesh);
  const ChartSurface surface = make_chart_surface(unit, 2);
  Progress progress;
  ChartOptions options;
  options.texels_per_unit = 300;
  const auto charts = grow_charts(surface, options, progress);
  ASSERT_TRUE(charts);
  ASSERT_GT(charts->size(), 2u);
  std::vector<glm::vec2> one, three;
  flatten(surface, *charts, 0, progress, one, 1);
  flatten(surface, *charts, 0, progress, three, 3);
  EXPECT_EQ(one, three);
}

TEST(mesh_chart_conflicts, finds_the_later_of_two_faces_that_share_a_texel) {
  Chart chart;
  chart.faces = {0, 1, 2};
  // Triangle 1 is next to triangle 0. Triangle 2 covers parts of both.
  const std::vector<glm::vec2> uvs{{0.1f, 0.1f}, {0.5f, 0.1f}, {0.1f, 0.5f},
                                   {0.5f, 0.1f}, {0.5f, 0.5f}, {0.1f, 0.5f},
                                   {0.2f, 0.2f}, {0.4f, 0.2f}, {0.3f, 0.4f}};
  const std::vector<Chart> charts{chart};
  const std::array resolutions{64, 128};
  EXPECT_THAT(faces_in_conflict(charts, uvs, resolutions), testing::ElementsAre(2));
  EXPECT_THAT(faces_in_conflict({charts.data(), 1}, std::span(uvs).first(6 + 3), std::array{1}),
              testing::IsEmpty())
      << "no centre of a texel is covered twice there";
}

TEST(mesh_chart_conflicts, finds_what_shows_only_at_a_higher_resolution) {
  Chart chart;
  chart.faces = {0, 1};
  // The triangles overlap around (0.28, 0.28): between texel centers at a resolution of 16, and
  // over some centers at 128.
  const std::vector<glm::vec2> uvs{{0.1f, 0.1f},   {0.29f, 0.1f}, {0.29f, 0.29f},
                                   {0.285f, 0.1f}, {0.45f, 0.1f}, {0.285f, 0.29f}};
  const std::vector<Chart> charts{chart};
  EXPECT_THAT(faces_in_conflict(charts, uvs, std::array{16}), testing::IsEmpty());
  EXPECT_THAT(faces_in_conflict(charts, uvs, std::array{16, 256}), testing::ElementsAre(1));
}

}  // namespace
}  // namespace strata::mesh
