#include "mesh/surface/open_edges.h"

#include <gtest/gtest.h>

#include <numeric>

#include "support/meshes.h"

namespace strata {
namespace {

using mesh::measure_open_edges;

// Returns separate strips of two triangles with the given lengths and a width of 1, next to each
// other.
mesh::Geometry strips(const std::vector<double>& lengths) {
  mesh::Geometry geometry;
  geometry.origin = {5, 5, 0};
  for (const double length : lengths) {
    const auto first = static_cast<std::uint32_t>(geometry.positions.size());
    const double y = 2.0 * first;
    for (const glm::dvec3& position :
         {glm::dvec3(0, y, 0), {length, y, 0}, {length, y + 1, 0}, {0, y + 1, 0}}) {
      mesh::Vertex vertex{};
      vertex.position = glm::vec3(position - geometry.origin);
      vertex.position_index = static_cast<std::uint32_t>(geometry.positions.size());
      geometry.vertices.push_back(vertex);
      geometry.positions.push_back(position);
    }
    for (const std::uint32_t corner : {0, 1, 2, 0, 2, 3})
      geometry.indices.push_back(first + corner);
  }
  return geometry;
}

TEST(OpenEdges, loops_are_counted_and_the_longest_come_first) {
  const OpenEdges edges = measure_open_edges(strips({3, 9, 5}));
  EXPECT_EQ(edges.loops, 3u);
  EXPECT_EQ(edges.longest, (std::vector<double>{20, 12, 8}));
  EXPECT_DOUBLE_EQ(edges.length, 40);
}

TEST(OpenEdges, of_many_loops_the_longest_are_listed_and_all_are_counted) {
  std::vector<double> lengths(100);
  std::iota(lengths.begin(), lengths.end(), 1);
  const OpenEdges edges = measure_open_edges(strips(lengths));
  EXPECT_EQ(edges.loops, 100u);
  ASSERT_EQ(edges.longest.size(), OpenEdges::kMaxListed);
  EXPECT_DOUBLE_EQ(edges.longest.front(), 202);
  EXPECT_DOUBLE_EQ(edges.longest.back(), 172);
  EXPECT_DOUBLE_EQ(edges.length, 10'300);
}

TEST(OpenEdges, seams_of_the_atlas_are_none) {
  const mesh::TriangleMesh sphere = test::sphere(24);
  Progress progress;
  const auto atlas = mesh::make_atlas(sphere, 256, progress);
  ASSERT_TRUE(atlas);
  const mesh::Geometry geometry = mesh::build_geometry(sphere, *atlas);
  ASSERT_GT(geometry.vertices.size(), geometry.positions.size()) << "there are seams";
  const OpenEdges edges = measure_open_edges(geometry);
  EXPECT_EQ(edges.loops, 0u);
  EXPECT_EQ(edges.length, 0);
  EXPECT_TRUE(edges.longest.empty());
}

TEST(OpenEdges, come_back_from_their_stored_form) {
  const OpenEdges edges{2, 3.25, {2.25, 1}};
  const auto stored = open_edges_from_json(to_json(edges, 1.0));
  ASSERT_TRUE(stored);
  EXPECT_EQ(stored->loops, 2u);
  EXPECT_EQ(stored->length, 3.25);
  EXPECT_EQ(stored->longest, edges.longest);
  EXPECT_FALSE(open_edges_from_json(nlohmann::json()));
  EXPECT_DOUBLE_EQ(to_json(edges, 0.001).at("longest_m").at(0).get<double>(), 0.00225);
}

}  // namespace
}  // namespace strata
