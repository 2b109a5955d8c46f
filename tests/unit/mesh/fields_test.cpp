#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "mesh/analysis/curvature.h"
#include "mesh/analysis/model_distance.h"
#include "mesh/analysis/openness.h"
#include "mesh/analysis/sampled_field.h"
#include "mesh/atlas/atlas.h"
#include "mesh/surface/boundary.h"
#include "support/meshes.h"

namespace strata::mesh {
namespace {

std::shared_ptr<const Geometry> geometry_of(const TriangleMesh& mesh) {
  return std::make_shared<const Geometry>(build_geometry(mesh, Atlas{}));
}

// Returns heights over a square with a side of 2 around the origin, on an irregular grid. Every
// vertex is moved slightly within the square.
template <class Height>
TriangleMesh height_field(int cells, Height height, double noise = 0) {
  TriangleMesh mesh = test::open_grid(cells, 0);
  mesh.corner_uvs.clear();
  std::mt19937 random(3);
  const auto shake = [&] { return random() / 4294967296.0 - 0.5; };
  for (auto& p : mesh.positions) {
    p.x = 2 * p.x - 1 + 0.6 * shake() / cells;
    p.y = 2 * p.y - 1 + 0.6 * shake() / cells;
    p.z = height(p.x, p.y) + noise * shake();
  }
  return mesh;
}

SurfaceSamples samples_of(const Geometry& geometry, float radius, int threads = 2) {
  Progress progress;
  auto samples = SurfaceSamples::make(geometry, radius, progress, threads);
  EXPECT_TRUE(samples);
  return std::move(*samples);
}

Curvature curvature_near_origin(const TriangleMesh& mesh, float radius) {
  const auto geometry = geometry_of(mesh);
  const SurfaceSamples samples = samples_of(*geometry, radius);
  const SurfaceNormals normals(geometry);
  std::uint32_t nearest = 0;
  const auto distance = [&](std::uint32_t i) { return glm::length(geometry->positions[i]); };
  for (std::uint32_t i = 0; i < geometry->positions.size(); ++i)
    if (distance(i) < distance(nearest)) nearest = i;
  const auto curvature =
      curvature_at(samples, glm::vec3(geometry->positions[nearest] - geometry->origin),
                   normals.at_position(nearest));
  EXPECT_TRUE(curvature.has_value());
  return curvature.value_or(Curvature{});
}

TEST(Curvature, of_a_sphere_is_one_over_its_radius_everywhere_and_positive) {
  // The radius is 5.
  const auto geometry = geometry_of(test::transformed(test::sphere(160), 5, {100, 0, 0}));
  const SurfaceSamples samples = samples_of(*geometry, 0.8f);
  const SurfaceNormals normals(geometry);
  for (std::uint32_t i = 0; i < geometry->positions.size(); i += 97) {
    const auto c = curvature_at(samples, glm::vec3(geometry->positions[i] - geometry->origin),
                                normals.at_position(i));
    ASSERT_TRUE(c) << i;
    EXPECT_NEAR(c->mean(), 0.2, 0.004) << i;
    EXPECT_NEAR(c->gaussian(), 0.04, 0.0016) << i;
    EXPECT_GE(c->max, c->min);
  }
}

TEST(Curvature, of_a_hollow_is_negative) {
  const Curvature c = curvature_near_origin(
      height_field(80, [](double x, double y) { return (x * x + y * y) / 4; }), 0.2f);
  EXPECT_NEAR(c.mean(), -0.5, 0.01);
  EXPECT_NEAR(c.gaussian(), 0.25, 0.01);
}

TEST(Curvature, of_a_cylinder_is_zero_along_it) {
  const Curvature c = curvature_near_origin(
      height_field(80, [](double x, double) { return std::sqrt(4 - x * x) - 2; }), 0.2f);
  EXPECT_NEAR(c.max, 0.5, 0.01);
  EXPECT_NEAR(c.min, 0, 0.01);
}

TEST(Curvature, of_a_saddle_has_both_signs) {
  const Curvature c = curvature_near_origin(
      height_field(80, [](double x, double y) { return (x * x - y * y) / 2; }), 0.2f);
  EXPECT_NEAR(c.max, 1, 0.02);
  EXPECT_NEAR(c.min, -1, 0.02);
  EXPECT_NEAR(c.mean(), 0, 0.01);
  EXPECT_NEAR(c.gaussian(), -1, 0.04);
}

TEST(Curvature, of_a_torus_follows_the_formula_around_the_tube) {
  const auto geometry = geometry_of(test::torus(320));  // radii 1 and 0.4
  const SurfaceSamples samples = samples_of(*geometry, 0.08f);
  const SurfaceNormals normals(geometry);
  for (std::uint32_t i = 0; i < geometry->positions.size(); i += 211) {
    const glm::dvec3 p = geometry->positions[i];
    const double ring = std::hypot(p.x, p.y), cosine = (ring - 1) / 0.4;
    const auto c = curvature_at(samples, glm::vec3(p - geometry->origin), normals.at_position(i));
    ASSERT_TRUE(c);
    EXPECT_NEAR(c->max, 2.5, 0.05);
    EXPECT_NEAR(c->min, cosine / (1 + 0.4 * cosine), 0.03) << cosine;
  }
}

TEST(Curvature, does_not_depend_on_noise_that_is_finer_than_the_radius) {
  const auto bowl = [](double x, double y) { return (x * x + y * y) / 4; };
  // The noise is a sixth of an edge, which rotates single faces by about ten degrees.
  const Curvature c = curvature_near_origin(height_field(160, bowl, 0.002), 0.25f);
  EXPECT_NEAR(c.mean(), -0.5, 0.05);
}

TEST(Curvature, of_a_thin_wall_is_not_disturbed_by_its_other_side) {
  TriangleMesh wall = height_field(60, [](double x, double y) { return -(x * x + y * y) / 4; });
  const auto count = static_cast<std::uint32_t>(wall.positions.size());
  const std::size_t corners = wall.triangles.size();
  for (std::uint32_t i = 0; i < count; ++i)
    wall.positions.push_back(wall.positions[i] - glm::dvec3(0, 0, 0.05));
  for (std::size_t i = 0; i < corners; i += 3)
    for (const std::size_t k : {0, 2, 1}) wall.triangles.push_back(wall.triangles[i + k] + count);
  EXPECT_NEAR(curvature_near_origin(wall, 0.2f).mean(), 0.5, 0.01);
}

TEST(Curvature, is_none_where_a_strip_has_no_width) {
  TriangleMesh sliver;
  sliver.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1e-6, 0}};
  sliver.triangles = {0, 1, 2};
  const auto geometry = geometry_of(sliver);
  const SurfaceSamples samples = samples_of(*geometry, 0.1f);
  EXPECT_FALSE(curvature_at(samples, {0, 0, 0}, {0, 0, 1}));
  EXPECT_FALSE(roughness_at(samples, {0, 0, 0}, {0, 0, 1}));
  EXPECT_FALSE(curvature_at(samples, {50, 0, 0}, {0, 0, 1}));
}

// Returns every sample near one of the points, without duplicates.
std::vector<std::array<float, 7>> samples_near(const SurfaceSamples& samples,
                                               const std::vector<glm::vec3>& points) {
  std::vector<std::array<float, 7>> all;
  for (const glm::vec3& point : points)
    for (const float sign : {1.0f, -1.0f})
      for (int axis = 0; axis < 3; ++axis) {
        glm::vec3 way(0);
        way[axis] = sign;
        samples.near(point, way, [&](const SurfaceSamples::Sample& s, float) {
          all.push_back({s.position.x, s.position.y, s.position.z, s.normal.x, s.normal.y,
                         s.normal.z, s.area});
        });
      }
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

TEST(SurfaceSamples, stand_for_all_of_the_surface_however_long_its_triangles_are) {
  TriangleMesh sheet = test::open_grid(2, 0);  // 8 triangles, each across many bands of cells
  for (auto& p : sheet.positions) p.y *= 3;
  for (const double turned : {0.0, 0.3, 1.2})
    for (int axis = 0; axis < 3; ++axis) {
      for (auto& p : sheet.positions) p = {p.y, p.z, p.x};
      TriangleMesh mesh = sheet;
      for (auto& p : mesh.positions)
        p = {std::cos(turned) * p.x - std::sin(turned) * p.y,
             std::sin(turned) * p.x + std::cos(turned) * p.y, p.z};
      const auto geometry = geometry_of(mesh);
      std::vector<glm::vec3> points;
      for (std::size_t t = 0; t < geometry->triangle_count(); ++t)
        for (int i = 0; i <= 40; ++i)
          for (int j = 0; i + j <= 40; ++j) {
            const auto at = [&](int k) {
              return geometry->vertices[geometry->indices[3 * t + k]].position;
            };
            points.push_back(at(0) + (at(1) - at(0)) * (float(i) / 40) +
                             (at(2) - at(0)) * (float(j) / 40));
          }
      double area = 0;
      const auto all = samples_near(samples_of(*geometry, 0.1f), points);
      for (const auto& sample : all) area += sample[6];
      EXPECT_NEAR(area, 3, 1e-4) << turned << " " << axis;
    }
}

TEST(SurfaceSamples, do_not_depend_on_the_number_of_threads) {
  const auto geometry = geometry_of(test::sphere(60));
  std::vector<glm::vec3> points;
  for (const Vertex& vertex : geometry->vertices) points.push_back(vertex.position);
  const auto one = samples_of(*geometry, 0.1f, 1), three = samples_of(*geometry, 0.1f, 3);
  EXPECT_EQ(one.size(), three.size());
  EXPECT_EQ(samples_near(one, points), samples_near(three, points));
  EXPECT_GE(samples_near(one, points).size(), one.size() * 9 / 10);
}

TEST(SurfaceSamples, can_be_cancelled) {
  Progress progress;
  progress.cancel();
  const auto cancelled = SurfaceSamples::make(*geometry_of(test::sphere(24)), 0.1f, progress);
  ASSERT_FALSE(cancelled);
  EXPECT_EQ(cancelled.error().code, ErrorCode::cancelled);
}

TEST(Roughness, is_the_distance_of_a_bump_to_the_plane_around_it) {
  const auto bump = [](double x, double y) { return std::hypot(x, y) < 0.03 ? 0.02 : 0.0; };
  const auto geometry = geometry_of(height_field(160, bump));
  const SurfaceSamples samples = samples_of(*geometry, 0.4f);
  const auto at = [&](const glm::dvec3& p) {
    return roughness_at(samples, glm::vec3(p - geometry->origin), {0, 0, 1}).value_or(-1);
  };
  EXPECT_NEAR(at({0, 0, 0.02}), 0.02, 0.001);
  EXPECT_NEAR(at({0.6, 0.6, 0}), 0, 1e-6);
  EXPECT_NEAR(at({0.95, 0.95, 0}), 0, 1e-6);  // in the corner of the sheet
}

TEST(Roughness, does_not_see_the_slope_of_a_plane) {
  const auto geometry = geometry_of(height_field(60, [](double x, double y) { return 3 * x - y; }));
  const SurfaceSamples samples = samples_of(*geometry, 0.3f);
  const glm::vec3 normal = glm::normalize(glm::vec3(-3, 1, 1));
  for (std::size_t i = 0; i < geometry->positions.size(); i += 37)
    EXPECT_NEAR(roughness_at(samples, glm::vec3(geometry->positions[i] - geometry->origin), normal)
                    .value_or(-1),
                0, 1e-5);
}

TEST(Openness, is_one_on_a_ball_and_none_inside_it) {
  const auto ball = geometry_of(test::sphere(48));
  Progress progress;
  const auto openness = Openness::make(ball, 10, 64, progress);
  ASSERT_TRUE(openness);
  for (const Vertex& v : ball->vertices) {
    const glm::vec3 out = glm::normalize(v.position);
    EXPECT_GT((*openness)->at(v.position * 1.001f, out), 0.98f);
    EXPECT_EQ((*openness)->at(v.position * 0.9f, -out), 0);
  }
}

TEST(Openness, can_be_cancelled_while_its_tree_is_made) {
  Progress progress;
  progress.cancel();
  const auto openness = Openness::make(geometry_of(test::sphere(200)), 10, 64, progress);
  ASSERT_FALSE(openness);
  EXPECT_EQ(openness.error().code, ErrorCode::cancelled);
}

TEST(Openness, at_the_foot_of_a_wall_is_a_half) {
  TriangleMesh corner;  // a floor and a wall that meet along y, both larger than the rays (50)
  corner.positions = {{0, -100, 0}, {100, -100, 0}, {100, 100, 0},
                      {0, 100, 0},  {0, -100, 100}, {0, 100, 100}};
  corner.triangles = {0, 1, 2, 0, 2, 3, 0, 3, 5, 0, 5, 4};
  Progress progress;
  const auto openness = Openness::make(geometry_of(corner), 50, 1024, progress);
  ASSERT_TRUE(openness);
  const glm::vec3 origin = geometry_of(corner)->origin;
  EXPECT_NEAR((*openness)->at(glm::vec3(0.01f, 0, 0) - origin, {0, 0, 1}), 0.5, 0.02);
  // The point is farther from the wall than the length of the rays, 50.
  EXPECT_NEAR((*openness)->at(glm::vec3(60, 0, 0) - origin, {0, 0, 1}), 1, 0.001);
}

TEST(Boundary, is_the_rim_of_a_sheet_and_nothing_of_a_ball) {
  EXPECT_EQ(boundary_edges(*geometry_of(test::open_grid(20))).size(), 80u);
  EXPECT_TRUE(boundary_edges(*geometry_of(test::sphere(24))).empty());
  EXPECT_TRUE(BoundaryDistance(*geometry_of(test::sphere(24))).is_closed());
}

TEST(Boundary, of_three_triangles_at_one_edge_is_none) {
  const auto geometry = geometry_of(test::grid_with_fins(6));
  for (const auto& edge : boundary_edges(*geometry)) {
    int uses = 0;
    for (std::size_t c = 0; c < geometry->indices.size(); ++c) {
      const auto at = [&](std::size_t corner) {
        return geometry->vertices[geometry->indices[corner]].position_index;
      };
      const auto a = at(c), b = at(c % 3 == 2 ? c - 2 : c + 1);
      uses += (a == edge[0] && b == edge[1]) || (a == edge[1] && b == edge[0]);
    }
    EXPECT_EQ(uses, 1);
  }
}

TEST(Boundary, distance_is_that_to_the_nearest_side_of_a_square) {
  const auto geometry = geometry_of(test::open_grid(20, 0));
  const BoundaryDistance distance(*geometry);
  for (const auto& p : geometry->positions)
    EXPECT_NEAR(distance.at(glm::vec3(p - geometry->origin)),
                std::min({p.x, 1 - p.x, p.y, 1 - p.y}), 1e-6);
}

TEST(ModelDistance, of_two_balls_has_the_sign_of_the_side_and_the_unit_of_the_first) {
  // `there` is in meters and `here` is in millimeters. Both balls have the same center.
  const auto there = geometry_of(test::transformed(test::sphere(200), 1, {5, 0, 0}));
  const auto here = geometry_of(test::transformed(test::sphere(40), 1200, {5000, 0, 0}));
  const ModelDistance distance(here->origin, 0.001, there, 1, 400);
  for (const auto& p : here->positions)
    EXPECT_NEAR(distance.at(glm::vec3(p - here->origin)), 200, 1);
  const auto inner = geometry_of(test::transformed(test::sphere(40), 900, {5000, 0, 0}));
  const ModelDistance inside(inner->origin, 0.001, there, 1, 400);
  for (const auto& p : inner->positions)
    EXPECT_NEAR(inside.at(glm::vec3(p - inner->origin)), -100, 1);
  const ModelDistance near_only(here->origin, 0.001, there, 1, 150);
  EXPECT_TRUE(std::isnan(near_only.at(glm::vec3(here->positions[0] - here->origin))));
}

TEST(SampledField, interpolates_a_linear_function_exactly_on_small_and_large_triangles) {
  for (const auto& [name, mesh] : test::mesh_classes()) {
    const auto geometry = geometry_of(mesh);
    const SurfaceNormals normals(geometry);
    const auto plane = [](const glm::vec3& p, const glm::vec3&) { return 3 * p.x - 2 * p.y + p.z; };
    for (const float spacing : {1000.0f, 0.21f}) {
      Progress progress;
      const auto field = SampledField::make(geometry, normals, spacing, plane, progress);
      ASSERT_TRUE(field) << name;
      for (std::uint32_t t = 0; t < geometry->triangle_count(); t += 5)
        for (const glm::vec3 w : {glm::vec3(0.2f, 0.5f, 0.3f), glm::vec3(1, 0, 0),
                                  glm::vec3(0, 0, 1), glm::vec3(0, 0.5f, 0.5f)}) {
          glm::vec3 p(0);
          for (int k = 0; k < 3; ++k)
            p += w[k] * geometry->vertices[geometry->indices[3 * t + k]].position;
          EXPECT_NEAR(field->at(t, w), plane(p, {}), 1e-4 * (1 + glm::length(geometry->box_max)))
              << name;
        }
    }
  }
}

TEST(SampledField, sees_what_lies_within_a_large_triangle) {
  TriangleMesh one;
  one.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  one.triangles = {0, 1, 2};
  const auto geometry = geometry_of(one);
  const auto hill = [&](const glm::vec3& p, const glm::vec3&) {
    const glm::dvec3 world = glm::dvec3(p) + geometry->origin;
    return static_cast<float>(std::hypot(world.x - 0.3, world.y - 0.3));
  };
  Progress progress;
  const auto field = SampledField::make(geometry, SurfaceNormals(geometry), 0.01f, hill, progress);
  ASSERT_TRUE(field);
  EXPECT_NEAR(field->at(0, {0.4f, 0.3f, 0.3f}), 0, 0.01);
  EXPECT_NEAR(field->at(0, {0.6f, 0.1f, 0.3f}), 0.2, 0.01);
}

TEST(SampledField, leaves_out_corners_without_a_value_and_can_be_cancelled) {
  const auto geometry = geometry_of(test::open_grid(4, 0));
  const SurfaceNormals normals(geometry);
  Progress progress;
  const float none = std::nanf("");
  const auto half = SampledField::make(
      geometry, normals, 10,
      [&](const glm::vec3& p, const glm::vec3&) { return p.x < 0 ? none : 7.0f; }, progress);
  ASSERT_TRUE(half);
  int defined = 0;
  for (std::uint32_t t = 0; t < geometry->triangle_count(); ++t) {
    const float value = half->at(t, glm::vec3(1 / 3.0f));
    if (std::isnan(value)) continue;
    EXPECT_FLOAT_EQ(value, 7);
    ++defined;
  }
  EXPECT_GT(defined, 0);
  EXPECT_LT(defined, 32);
  progress.cancel();
  const auto cancelled = SampledField::make(
      geometry, normals, 10, [](const glm::vec3&, const glm::vec3&) { return 1.0f; }, progress);
  ASSERT_FALSE(cancelled);
  EXPECT_EQ(cancelled.error().code, ErrorCode::cancelled);
}

TEST(SurfaceNormals, are_smooth_on_a_ball_and_those_of_the_faces_on_a_cube) {
  const auto ball = geometry_of(test::sphere(48));
  const SurfaceNormals smooth(ball);
  for (std::uint32_t t = 0; t < ball->triangle_count(); ++t) {
    glm::vec3 middle(0);
    for (int k = 0; k < 3; ++k) middle += ball->vertices[ball->indices[3 * t + k]].position / 3.0f;
    EXPECT_GT(glm::dot(smooth.at(t, glm::vec3(1 / 3.0f)), glm::normalize(middle)), 0.999f);
  }
  const auto cube = geometry_of(test::cube_with_face_charts());
  const SurfaceNormals sharp(cube);
  for (std::uint32_t t = 0; t < cube->triangle_count(); ++t)
    EXPECT_GT(glm::dot(sharp.at(t, {0.9f, 0.05f, 0.05f}), sharp.of_face(t)), 0.9999f);
}

}  // namespace
}  // namespace strata::mesh
