#include "mesh/surface/simplify.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "mesh/surface/search_tree.h"
#include "support/meshes.h"
#include "support/scene_models.h"

namespace strata::mesh {
namespace {

Geometry simplified(const Geometry& geometry, std::size_t triangles) {
  Progress progress;
  auto result = simplify(geometry, triangles, progress);
  EXPECT_TRUE(result) << result.error().detail;
  return std::move(*result);
}

Geometry unwrapped(const TriangleMesh& mesh) { return *test::geometry_of(mesh); }

template <class Visit>
void for_each_triangle(const Geometry& geometry, Visit visit) {
  for (std::size_t i = 0; i + 2 < geometry.indices.size(); i += 3)
    visit(geometry.vertices[geometry.indices[i]], geometry.vertices[geometry.indices[i + 1]],
          geometry.vertices[geometry.indices[i + 2]]);
}

TEST(Simplify, reaches_the_number_of_triangles_and_stays_near_a_sphere) {
  const Geometry full = unwrapped(test::sphere(200));  // 39 600 triangles, radius 1
  for (const std::size_t wanted : {20'000u, 5'000u, 2'000u}) {
    const Geometry coarse = simplified(full, wanted);
    EXPECT_LE(coarse.triangle_count(), wanted);
    EXPECT_GE(coarse.triangle_count(), wanted * 95 / 100);
    for (const glm::dvec3& position : coarse.positions) ASSERT_NEAR(glm::length(position), 1, 1e-6);
    // The centers of triangles of edge e, with corners on a sphere of radius 1, are about e² / 6
    // inside. Reduced triangles differ in size and shape.
    double sum = 0;
    const double edge2 = 4 / std::sqrt(3.0) * surface_area(full) / static_cast<double>(wanted);
    for_each_triangle(coarse, [&](const Vertex& a, const Vertex& b, const Vertex& c) {
      const glm::vec3 center = (a.position + b.position + c.position) / 3.0f;
      const double inside = 1 - glm::length(glm::dvec3(center) + coarse.origin);
      ASSERT_GT(inside, -1e-6) << wanted;
      ASSERT_LT(inside, 8 * edge2 / 6) << wanted;
      sum += inside;
    });
    EXPECT_LT(sum / static_cast<double>(coarse.triangle_count()), 1.5 * edge2 / 6) << wanted;
    EXPECT_NEAR(surface_area(coarse), surface_area(full), edge2 * surface_area(full)) << wanted;
  }
}

TEST(Simplify, leaves_no_gaps_at_the_seams_of_the_atlas) {
  const Geometry coarse = simplified(unwrapped(test::sphere(200)), 3'000);
  ASSERT_GT(coarse.vertices.size(), coarse.positions.size()) << "the test needs seams";
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;  // by positions, and direction
  for_each_triangle(coarse, [&](const Vertex& a, const Vertex& b, const Vertex& c) {
    ++edges[{a.position_index, b.position_index}];
    ++edges[{b.position_index, c.position_index}];
    ++edges[{c.position_index, a.position_index}];
  });
  for (const auto& [edge, count] : edges) {
    ASSERT_EQ(count, 1);
    ASSERT_TRUE(edges.contains({edge.second, edge.first})) << "a gap";
  }
}

TEST(Simplify, keeps_a_plane_and_its_texture_exactly) {
  const auto full = test::with_own_uvs(test::open_grid(60, 0));
  const Geometry coarse = simplified(*full, 100);
  EXPECT_LE(coarse.triangle_count(), 100u);
  // Some triangles of an exact plane fold, because all collapses have the same error.
  EXPECT_NEAR(surface_area(coarse), 1, 0.05);
  EXPECT_EQ(coarse.box_min, full->box_min);
  EXPECT_EQ(coarse.box_max, full->box_max);
  for_each_triangle(coarse, [&](const Vertex& a, const Vertex& b, const Vertex& c) {
    // The texture coordinates of the grid are an affine function of the position.
    const glm::dvec3 center =
        (glm::dvec3(a.position) + glm::dvec3(b.position) + glm::dvec3(c.position)) / 3.0 +
        coarse.origin;
    const glm::vec2 uv = (a.uv + b.uv + c.uv) / 3.0f;
    ASSERT_NEAR(center.z, 0, 1e-9);
    ASSERT_NEAR(uv.x, 0.05 + 0.9 * center.x, 1e-5);
    ASSERT_NEAR(uv.y, 0.05 + 0.9 * center.y, 1e-5);
  });
}

TEST(Simplify, shows_the_texture_of_the_place_on_a_curved_surface) {
  const auto full = std::make_shared<const Geometry>(unwrapped(test::torus(200)));
  const Geometry coarse = simplified(*full, full->triangle_count() / 4);
  const SearchTree tree(full);
  double sum = 0, count = 0;
  for_each_triangle(coarse, [&](const Vertex& a, const Vertex& b, const Vertex& c) {
    const auto hit = tree.nearest((a.position + b.position + c.position) / 3.0f, 1.0f);
    ASSERT_TRUE(hit);
    sum += glm::distance((a.uv + b.uv + c.uv) / 3.0f, hit->uv);
    ++count;
  });
  EXPECT_LT(sum / count, 0.5 / 1024);  // half a pixel of a texture with 1024 pixels
}

TEST(Simplify, changes_nothing_if_the_number_is_large_enough) {
  const Geometry full = unwrapped(test::open_grid(10));
  EXPECT_EQ(simplified(full, full.triangle_count()).indices, full.indices);
}

TEST(Simplify, refuses_a_number_that_would_destroy_the_surface_and_names_a_possible_one) {
  for (const auto& [mesh, possible] :
       {std::pair(test::cubes(40), 480u), std::pair(test::separate_triangles(400), 400u),
        std::pair(test::cube_with_face_charts(), 12u)}) {
    const Geometry full = unwrapped(mesh);
    Progress progress;
    const auto refused = simplify(full, 4, progress);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::invalid);
    EXPECT_EQ(refused.error().field, "max_triangles");
    EXPECT_NE(refused.error().detail.find(std::to_string(possible)), std::string::npos)
        << refused.error().detail;
    EXPECT_EQ(simplified(full, possible).triangle_count(), possible);
  }
}

TEST(Simplify, ends_when_it_is_cancelled) {
  const Geometry full = unwrapped(test::sphere(100));
  for (const int question : {0, 1}) {
    test::CancelledAt cancelled(question);
    const auto ended = simplify(full, 200, cancelled);
    ASSERT_FALSE(ended);
    EXPECT_EQ(ended.error().code, ErrorCode::cancelled);
  }
}

}  // namespace
}  // namespace strata::mesh
