#include <gtest/gtest.h>

#include <map>

#include "mesh/demo/demo_pot.h"
#include "mesh/io/load_formats.h"

namespace {

using namespace strata;
using mesh::TriangleMesh;

class DemoPot : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(details, DemoPot, testing::Values(0.001, 0.02, 0.1, 0.37, 1.0));

TEST_P(DemoPot, is_closed_manifold_and_oriented_outward) {
  const TriangleMesh pot = mesh::make_demo_pot(GetParam());
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  double volume = 0;
  for (std::size_t i = 0; i < pot.triangles.size(); i += 3) {
    for (std::size_t k = 0; k < 3; ++k)
      ++edges[{pot.triangles[i + k], pot.triangles[i + (k + 1) % 3]}];
    volume +=
        glm::dot(pot.positions[pot.triangles[i]], glm::cross(pot.positions[pot.triangles[i + 1]],
                                                             pot.positions[pot.triangles[i + 2]])) /
        6;
  }
  for (const auto& [edge, count] : edges) {
    ASSERT_EQ(count, 1);
    ASSERT_TRUE(edges.contains({edge.second, edge.first}));
  }
  // V − E + F is 2, as for a sphere. All edges are closed, so this excludes vertices at which two
  // sheets only touch.
  EXPECT_EQ(static_cast<long>(pot.positions.size()) - static_cast<long>(edges.size() / 2) +
                static_cast<long>(pot.triangle_count()),
            2);
  EXPECT_GT(volume, 80000);  // mm³ of clay
  // A solid pot would have far more, but the wall is thin and the inside is open.
  EXPECT_LT(volume, 250000);
}

TEST_P(DemoPot, loses_nothing_to_repair) {
  mesh::LoadedMesh loaded{mesh::make_demo_pot(GetParam()), {}};
  const std::size_t triangles = loaded.mesh.triangle_count(),
                    vertices = loaded.mesh.positions.size();
  Progress progress;
  ASSERT_TRUE(mesh::repair(loaded, progress));
  EXPECT_EQ(loaded.mesh.triangle_count(), triangles);
  EXPECT_EQ(loaded.mesh.positions.size(), vertices);
}

TEST_P(DemoPot, has_its_stated_size_and_colours) {
  const TriangleMesh pot = mesh::make_demo_pot(GetParam());
  glm::dvec3 low = pot.positions[0], high = low;
  for (const auto& p : pot.positions) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  EXPECT_NEAR(high.x - low.x, 105, 1e-9);
  EXPECT_NEAR(high.y - low.y, 99, 1e-9);
  EXPECT_NEAR(high.z - low.z, 91, 1e-9);
  EXPECT_NEAR(low.z, 0, 1e-9);
  ASSERT_EQ(pot.vertex_colors.size(), pot.positions.size());
  for (std::uint32_t color : pot.vertex_colors) EXPECT_EQ(color >> 24, 0xffu);
}

TEST(DemoPotModel, has_about_200_000_triangles_and_is_the_same_each_time) {
  const TriangleMesh a = mesh::make_demo_pot(), b = mesh::make_demo_pot();
  EXPECT_NEAR(static_cast<double>(a.triangle_count()), 200000, 10000);
  EXPECT_TRUE(a.positions == b.positions);
  EXPECT_EQ(a.triangles, b.triangles);
  EXPECT_EQ(a.vertex_colors, b.vertex_colors);
  EXPECT_NEAR(static_cast<double>(mesh::make_demo_pot(0.1).triangle_count()), 20000, 3000);
}

TEST(DemoPotModel, misses_a_sherd_in_front_and_has_a_whole_rim_behind) {
  const TriangleMesh pot = mesh::make_demo_pot(0.3);
  double front = 0, back = 0;
  for (const auto& p : pot.positions) {
    if (std::abs(p.x) > 3) continue;
    if (p.y < 0) front = std::max(front, p.z);
    if (p.y > 0) back = std::max(back, p.z);
  }
  EXPECT_LT(front, 62);
  EXPECT_GT(back, 86);
}

}  // namespace
