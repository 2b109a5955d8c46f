#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "mesh/analysis/vertex_openness.h"
#include "support/solids.h"

namespace strata {
namespace {

using test::add, test::ball, test::geometry_of;

std::uint32_t openness(const mesh::Vertex& vertex) { return vertex.color >> 24; }

TEST(VertexOpenness, is_dark_in_a_hollow_and_full_in_the_open) {
  auto shell = ball(24);
  add(shell, ball(24), 0.9, true);
  auto geometry = geometry_of(shell);
  const auto colors = geometry.vertices.front().color & 0xffffffu;
  Progress progress;
  ASSERT_TRUE(mesh::bake_openness(geometry, progress));
  for (const auto& vertex : geometry.vertices) {
    EXPECT_EQ(vertex.color & 0xffffffu, colors) << "only the openness changes";
    if (glm::length(vertex.position) > 0.95f) {
      EXPECT_GT(openness(vertex), 250u);
    } else {
      EXPECT_LT(openness(vertex), 255u);
    }
  }
}

TEST(VertexOpenness, of_a_wall_does_not_depend_on_the_winding) {
  auto inside_out = ball(24);
  add(inside_out, ball(24), 0.9, true);
  for (std::size_t i = 0; i < inside_out.triangles.size(); i += 3)
    std::swap(inside_out.triangles[i], inside_out.triangles[i + 1]);
  auto geometry = geometry_of(inside_out);
  Progress progress;
  ASSERT_TRUE(mesh::bake_openness(geometry, progress));
  for (const auto& vertex : geometry.vertices) {
    if (glm::length(vertex.position) < 0.95f) continue;
    EXPECT_GT(openness(vertex), 250u);
  }
}

TEST(VertexOpenness, darkens_the_corner_of_two_walls) {
  // A finely divided floor and wall.
  mesh::TriangleMesh corner;
  const int n = 20;
  const auto sheet = [&](const auto& place) {
    const auto first = static_cast<std::uint32_t>(corner.positions.size());
    for (int y = 0; y <= n; ++y)
      for (int x = 0; x <= n; ++x) corner.positions.push_back(place(x / double(n), y / double(n)));
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x) {
        const auto at = first + static_cast<std::uint32_t>(y * (n + 1) + x);
        for (const std::uint32_t index : {at, at + 1, at + n + 1, at + 1, at + n + 2, at + n + 1})
          corner.triangles.push_back(index);
      }
  };
  sheet([](double x, double y) { return glm::dvec3(x, y, 0); });
  sheet([](double x, double y) { return glm::dvec3(x, 1.02, y + 0.02); });
  auto geometry = geometry_of(corner);
  Progress progress;
  ASSERT_TRUE(mesh::bake_openness(geometry, progress));
  const auto floor_at = [&](double y) {
    double sum = 0;
    int count = 0;
    for (const auto& vertex : geometry.vertices) {
      const glm::dvec3 world = glm::dvec3(vertex.position) + geometry.origin;
      if (std::abs(world.z) > 1e-3 || std::abs(world.y - y) > 1e-3 || std::abs(world.x - 0.5) > 0.2)
        continue;
      sum += openness(vertex) / 255.0;
      ++count;
    }
    return sum / std::max(count, 1);
  };
  EXPECT_LT(floor_at(1.0), 0.75);
  EXPECT_GT(floor_at(0.2), 0.97);
  EXPECT_LT(floor_at(1.0), floor_at(0.9));
  EXPECT_LT(floor_at(0.9), floor_at(0.7) + 0.01);
}

TEST(VertexOpenness, is_copied_to_another_level_and_ends_when_cancelled) {
  auto shell = ball(24);
  auto from = geometry_of(shell), to = geometry_of(ball(40));
  for (auto& vertex : from.vertices)
    vertex.color = vertex.position.z > 0 ? 0xff000000u : 0x20000000u;
  mesh::copy_openness(from, to);
  for (const auto& vertex : to.vertices) {
    if (std::abs(vertex.position.z) < 0.2f) continue;
    EXPECT_EQ(openness(vertex), vertex.position.z > 0 ? 255u : 32u);
  }
  Progress progress;
  progress.cancel();
  const auto before = to.vertices.front().color;
  EXPECT_EQ(mesh::bake_openness(to, progress).error().code, ErrorCode::cancelled);
  EXPECT_EQ(to.vertices.front().color, before);
}

}  // namespace
}  // namespace strata
