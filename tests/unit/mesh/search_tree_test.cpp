#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "mesh/demo/demo_pot.h"
#include "mesh/surface/search_tree.h"

namespace {

using namespace strata;
using mesh::Geometry;
using mesh::SearchTree;
using mesh::TriangleMesh;

std::shared_ptr<Geometry> geometry_of(const TriangleMesh& mesh, const mesh::Atlas& atlas = {}) {
  return std::make_shared<Geometry>(mesh::build_geometry(mesh, atlas));
}

std::array<glm::dvec3, 3> corners(const Geometry& geometry, std::size_t triangle) {
  const auto at = [&](std::size_t k) {
    return glm::dvec3(geometry.vertices[geometry.indices[3 * triangle + k]].position);
  };
  return {at(0), at(1), at(2)};
}

// Returns the distance to a triangle, with a method that the tree does not use: the distance to the
// plane if the foot of the perpendicular is inside the triangle, otherwise the least distance to
// the three sides.
double oracle_distance(const glm::dvec3& p, const std::array<glm::dvec3, 3>& t) {
  double best = 1e300;
  for (int k = 0; k < 3; ++k) {
    const glm::dvec3 a = t[k], ab = t[(k + 1) % 3] - a;
    const double s = std::clamp(glm::dot(p - a, ab) / glm::dot(ab, ab), 0.0, 1.0);
    best = std::min(best, glm::distance(p, a + s * ab));
  }
  const glm::dvec3 n = glm::normalize(glm::cross(t[1] - t[0], t[2] - t[0]));
  const glm::dvec3 foot = p - n * glm::dot(p - t[0], n);
  bool inside = true;
  for (int k = 0; k < 3; ++k)
    inside = inside && glm::dot(glm::cross(t[(k + 1) % 3] - t[k], foot - t[k]), n) >= 0;
  return inside ? std::min(best, std::abs(glm::dot(p - t[0], n))) : best;
}

// Returns the distance along the ray by the method of Möller and Trumbore, or infinity.
double oracle_hit(const glm::dvec3& o, const glm::dvec3& d, const std::array<glm::dvec3, 3>& t) {
  const glm::dvec3 e1 = t[1] - t[0], e2 = t[2] - t[0], p = glm::cross(d, e2), s = o - t[0],
                   q = glm::cross(s, e1);
  const double det = glm::dot(e1, p), u = glm::dot(s, p) / det, v = glm::dot(d, q) / det,
               far = glm::dot(e2, q) / det;
  return u >= -1e-9 && v >= -1e-9 && u + v <= 1 + 1e-9 && far >= 0
             ? far
             : std::numeric_limits<double>::infinity();
}

class SearchTreeOracle : public testing::Test {
 protected:
  std::shared_ptr<Geometry> geometry_ = geometry_of(mesh::make_demo_pot(0.02));
  SearchTree tree_{geometry_};
  std::mt19937 random_{11};
  glm::vec3 random_point(float margin) {
    std::uniform_real_distribution<float> unit(-margin, 1 + margin);
    return geometry_->box_min + (geometry_->box_max - geometry_->box_min) *
                                    glm::vec3(unit(random_), unit(random_), unit(random_));
  }
};

TEST_F(SearchTreeOracle, the_nearest_point_is_the_one_that_every_triangle_agrees_on) {
  for (int i = 0; i < 300; ++i) {
    const glm::vec3 p = random_point(0.5f);
    double best = 1e300;
    for (std::size_t t = 0; t < geometry_->triangle_count(); ++t)
      best = std::min(best, oracle_distance(p, corners(*geometry_, t)));
    const auto hit = tree_.nearest(p, 1e6f);
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->distance, best, 1e-4);
    EXPECT_NEAR(glm::distance(hit->position, p), hit->distance, 1e-4);
    const auto t = corners(*geometry_, hit->triangle);
    EXPECT_NEAR(glm::distance(glm::dvec3(hit->position), double{hit->barycentric.x} * t[0] +
                                                             double{hit->barycentric.y} * t[1] +
                                                             double{hit->barycentric.z} * t[2]),
                0, 1e-4);
    EXPECT_NEAR(hit->barycentric.x + hit->barycentric.y + hit->barycentric.z, 1, 1e-5);
    EXPECT_GE(std::min({hit->barycentric.x, hit->barycentric.y, hit->barycentric.z}), -1e-6f);
    EXPECT_FALSE(tree_.nearest(p, static_cast<float>(best * 0.99)));
    EXPECT_TRUE(tree_.nearest(p, static_cast<float>(best * 1.01)));
  }
}

TEST_F(SearchTreeOracle, the_first_hit_of_a_ray_is_the_nearest_of_all_triangles) {
  int hits = 0;
  for (int i = 0; i < 400; ++i) {
    const glm::vec3 from = random_point(1), to = random_point(0);
    const glm::dvec3 direction = glm::normalize(glm::dvec3(to) - glm::dvec3(from));
    double best = std::numeric_limits<double>::infinity();
    for (std::size_t t = 0; t < geometry_->triangle_count(); ++t)
      best = std::min(best, oracle_hit(from, direction, corners(*geometry_, t)));
    const auto hit = tree_.first_hit(from, to - from);
    ASSERT_EQ(hit.has_value(), std::isfinite(best)) << i;
    if (!hit) continue;
    ++hits;
    EXPECT_NEAR(hit->distance, best, 1e-3);
    EXPECT_NEAR(glm::distance(glm::dvec3(hit->position),
                              glm::dvec3(from) + direction * double{hit->distance}),
                0, 1e-3);
  }
  EXPECT_GT(hits, 100);
}

TEST_F(SearchTreeOracle, no_ray_from_inside_a_closed_wall_escapes) {
  // The rays are aimed exactly at vertices and edges, where an inexact test lets rays pass between
  // triangles.
  const auto base = tree_.first_hit({0, 0, geometry_->box_min.z - 50}, {0, 0, 1});
  ASSERT_TRUE(base);
  const glm::vec3 inside = base->position + glm::vec3(0, 0, 2);
  for (const auto& vertex : geometry_->vertices) {
    EXPECT_TRUE(tree_.first_hit(inside, vertex.position - inside));
  }
  for (std::size_t i = 0; i + 1 < geometry_->indices.size(); i += 3) {
    const glm::vec3 middle = (geometry_->vertices[geometry_->indices[i]].position +
                              geometry_->vertices[geometry_->indices[i + 1]].position) /
                             2.0f;
    EXPECT_TRUE(tree_.first_hit(inside, middle - inside));
  }
}

TEST(MeshSearchTree, a_hit_tells_side_and_texture_coordinates) {
  TriangleMesh mesh;
  mesh.positions = {{100, 200, 5}, {104, 200, 5}, {100, 204, 5}};
  mesh.triangles = {0, 1, 2};
  mesh::Atlas atlas;
  atlas.corner_uvs = {{0, 0}, {1, 0}, {0, 1}};
  const SearchTree tree(geometry_of(mesh, atlas));  // origin 102 202 5
  const auto hit = tree.first_hit({-1, -1, 10}, {0, 0, -2});
  ASSERT_TRUE(hit);
  EXPECT_FLOAT_EQ(hit->distance, 10);
  EXPECT_EQ(hit->position, glm::vec3(-1, -1, 0));
  EXPECT_EQ(hit->normal, glm::vec3(0, 0, 1));
  EXPECT_FLOAT_EQ(hit->uv.x, 0.25f);
  EXPECT_FLOAT_EQ(hit->uv.y, 0.25f);
  EXPECT_TRUE(tree.first_hit({-1, -1, -10}, {0, 0, 1})) << "from behind, too";
  EXPECT_FALSE(tree.first_hit({-1, -1, 10}, {0, 0, 1}));
  EXPECT_FALSE(tree.first_hit({1, 1, 10}, {0, 0, -1}));
  EXPECT_TRUE(tree.first_hit({-2, -2, 10}, {0, 0, -1})) << "through a corner";
  EXPECT_FALSE(tree.first_hit({-10, -1, 0}, {1, 0, 0})) << "along the triangle";
  const auto corner = tree.nearest({9, -2, 0}, 100);
  ASSERT_TRUE(corner);
  EXPECT_FLOAT_EQ(corner->distance, 7);
  EXPECT_EQ(corner->uv, glm::vec2(1, 0));
}

TEST(MeshSearchTree, queries_that_mean_nothing_find_nothing) {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {0, 1, 2};
  const SearchTree tree(geometry_of(mesh));
  const float nan = std::numeric_limits<float>::quiet_NaN(),
              infinity = std::numeric_limits<float>::infinity();
  EXPECT_FALSE(tree.first_hit({0, 0, 1}, {0, 0, 0}));
  EXPECT_FALSE(tree.first_hit({0, nan, 1}, {0, 0, -1}));
  EXPECT_FALSE(tree.first_hit({0, 0, 1}, {0, 0, -infinity}));
  EXPECT_FALSE(tree.nearest({nan, 0, 0}, 1));
  EXPECT_FALSE(tree.nearest({0, 0, 0}, nan));
  EXPECT_FALSE(tree.nearest({0, 0, 0}, -1));
  EXPECT_TRUE(tree.nearest({0, 0, 0}, infinity));
  EXPECT_TRUE(tree.nearest({1e30f, 0, 0}, std::numeric_limits<float>::max()))
      << "its square is no float";
  const SearchTree empty(std::make_shared<Geometry>());
  EXPECT_FALSE(empty.nearest({0, 0, 0}, 1e9f));
  EXPECT_FALSE(empty.first_hit({0, 0, 1}, {0, 0, -1}));
}

TEST(MeshSearchTree, triangles_that_are_flat_in_float_are_found_without_nan) {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1e-9, 0, 0}, {0, 1e-9, 0}, {1000, 0, 0}, {1000, 1000, 0}};
  mesh.triangles = {0, 1, 2, 0, 3, 4};
  // The origin is (500, 500, 0), so the first triangle is a single point in float.
  const SearchTree tree(geometry_of(mesh));
  const auto hit = tree.nearest({-500, -500, 3}, 10);
  ASSERT_TRUE(hit);
  EXPECT_FLOAT_EQ(hit->distance, 3);
  EXPECT_EQ(hit->normal.z, 1.0f);
}

}  // namespace
