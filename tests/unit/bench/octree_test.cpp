#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <random>
#include <set>

#include "bench/peers/octree_edit.h"

namespace strata::bench {
namespace {

constexpr int kWidth = 160, kHeight = 120;

// Returns a curved sheet of triangles and a ball above it, which hides a part of the sheet.
mesh::Geometry small_geometry() {
  mesh::Geometry geometry;
  const auto add_grid = [&](int n, auto place) {
    const auto first = static_cast<std::uint32_t>(geometry.vertices.size());
    for (int y = 0; y <= n; ++y)
      for (int x = 0; x <= n; ++x) {
        mesh::Vertex vertex{};
        vertex.position = place(float(x) / float(n), float(y) / float(n));
        geometry.vertices.push_back(vertex);
      }
    const auto at = [&](int x, int y) {
      return first + static_cast<std::uint32_t>(y * (n + 1) + x);
    };
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x)
        for (const std::uint32_t i :
             {at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y), at(x + 1, y + 1), at(x, y + 1)})
          geometry.indices.push_back(i);
  };
  add_grid(9, [](float u, float v) {
    return glm::vec3(2 * u - 1, 2 * v - 1, 0.3f * std::sin(4 * u + 2 * v));
  });
  add_grid(12, [](float u, float v) {
    const float a = 6.2831853f * u, b = 3.1415926f * v;
    return glm::vec3(0.3f * std::cos(a) * std::sin(b), 0.2f + 0.3f * std::sin(a) * std::sin(b),
                     0.8f + 0.3f * std::cos(b));
  });
  geometry.box_min = glm::vec3(1e9f);
  geometry.box_max = glm::vec3(-1e9f);
  for (const auto& vertex : geometry.vertices) {
    geometry.box_min = glm::min(geometry.box_min, vertex.position);
    geometry.box_max = glm::max(geometry.box_max, vertex.position);
  }
  return geometry;
}

Octree build(const mesh::Geometry& geometry, int depth) {
  auto tree = Octree::build(geometry, depth, 3);
  EXPECT_TRUE(tree.has_value());
  return std::move(*tree);
}

OctreeDab dab_from(const glm::dvec3& eye, bool orthographic) {
  OctreeDab dab;
  dab.camera.view = glm::lookAt(eye, glm::dvec3(0, 0, 0.3), glm::dvec3(0, 1, 0));
  dab.camera.projection = orthographic ? glm::ortho(-1.6, 1.6, -1.2, 1.2, 0.1, 9.0)
                                       : glm::perspective(0.8, double(kWidth) / kHeight, 0.1, 9.0);
  dab.camera.width = kWidth;
  dab.camera.height = kHeight;
  dab.center = {83.3, 55.7};
  dab.radius_px = 31;
  dab.value = 9;
  dab.color = 0xff00ff00;
  return dab;
}

struct Ray {
  glm::dvec3 from, way;
};
Ray ray_of(const OctreeDab& dab, int x, int y) {
  const glm::dmat4 inverse = glm::inverse(dab.camera.projection * dab.camera.view);
  const auto at = [&](double z) {
    const glm::dvec4 p =
        inverse * glm::dvec4(2 * (x + 0.5) / kWidth - 1, 1 - 2 * (y + 0.5) / kHeight, z, 1);
    return glm::dvec3(p) / p.w;
  };
  return {at(-1), glm::normalize(at(1) - at(-1))};
}

// Returns the distance at which the ray enters each cell, or 1e9 for a missed cell.
std::vector<double> entries(const Octree& tree, const std::vector<glm::uvec3>& cells,
                            const Ray& ray) {
  std::vector<double> found;
  for (const auto& cell : cells) {
    const double side = tree.cell_side();
    const glm::dvec3 low = glm::dvec3(tree.low()) + glm::dvec3(cell) * side;
    const glm::dvec3 a = (low - ray.from) / ray.way, b = (low + side - ray.from) / ray.way;
    const glm::dvec3 near = glm::min(a, b), far = glm::max(a, b);
    const double enter = std::max({near.x, near.y, near.z, 0.0}),
                 leave = std::min({far.x, far.y, far.z});
    found.push_back(enter < leave - 1e-6 * side ? enter : 1e9);
  }
  return found;
}

std::set<std::size_t> painted(const OctreeLayer& layer) {
  std::set<std::size_t> leaves;
  for (std::size_t i = 0; i < layer.values.size(); ++i)
    if (layer.values[i] != 0) leaves.insert(i);
  return leaves;
}

TEST(Octree, its_leaves_are_the_cells_that_the_surface_crosses) {
  const auto geometry = small_geometry();
  const auto tree = build(geometry, 6);
  const auto cells = tree.leaf_cells();
  ASSERT_EQ(cells.size(), tree.leaf_count());
  std::set<std::array<unsigned, 3>> leaves;
  for (const auto& cell : cells) leaves.insert({cell.x, cell.y, cell.z});
  EXPECT_EQ(leaves.size(), cells.size());
  // Points on each triangle must be in leaves. Each leaf must have such a point inside or near its
  // border.
  std::set<std::array<unsigned, 3>> near_points;
  for (std::size_t t = 0; t < geometry.triangle_count(); ++t) {
    const auto corner = [&](std::size_t i) {
      return geometry.vertices[geometry.indices[3 * t + i]].position;
    };
    constexpr int kSteps = 60;
    for (int i = 0; i <= kSteps; ++i)
      for (int k = 0; k <= kSteps - i; ++k) {
        const float u = float(i) / kSteps, v = float(k) / kSteps;
        const glm::vec3 p = (corner(0) * (1 - u - v) + corner(1) * u + corner(2) * v - tree.low()) /
                            tree.cell_side();
        const glm::vec3 from_border = glm::abs(p - glm::round(p));
        if (std::min({from_border.x, from_border.y, from_border.z}) > 1e-3f) {
          ASSERT_TRUE(leaves.contains({unsigned(p.x), unsigned(p.y), unsigned(p.z)}));
        }
        for (int n = 0; n < 8; ++n) {
          const glm::vec3 q = p + 0.15f * glm::vec3(n & 1 ? 1 : -1, n & 2 ? 1 : -1, n & 4 ? 1 : -1);
          near_points.insert({unsigned(std::max(q.x, 0.f)), unsigned(std::max(q.y, 0.f)),
                              unsigned(std::max(q.z, 0.f))});
        }
      }
  }
  for (const auto& leaf : leaves)
    EXPECT_TRUE(near_points.contains(leaf)) << leaf[0] << " " << leaf[1] << " " << leaf[2];
}

TEST(Octree, rays_paint_the_first_leaf_on_their_way) {
  const auto tree = build(small_geometry(), 5);
  const auto cells = tree.leaf_cells();
  for (const bool orthographic : {false, true}) {
    for (const glm::dvec3 eye :
         {glm::dvec3(0.4, -1.5, 3), glm::dvec3(-2, 1.4, -1.7), glm::dvec3(-0.9, -0.9, 0.5)}) {
      const auto dab = dab_from(eye, orthographic);
      OctreeLayer layer(tree);
      const std::size_t hits = paint_by_rays(tree, dab, layer);
      std::set<std::size_t> first, first_or_as_near;
      std::size_t expected_hits = 0;
      for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
          if (glm::length(glm::dvec2(x + 0.5, y + 0.5) - dab.center) >= dab.radius_px) continue;
          const auto enter = entries(tree, cells, ray_of(dab, x, y));
          const auto nearest = std::min_element(enter.begin(), enter.end());
          if (*nearest >= 1e9) continue;
          ++expected_hits;
          for (std::size_t i = 0; i < enter.size(); ++i)
            if (enter[i] < *nearest + 1e-4) first_or_as_near.insert(i);
          first.insert(std::size_t(nearest - enter.begin()));
        }
      const auto got = painted(layer);
      EXPECT_GT(got.size(), 30u);
      EXPECT_NEAR(double(hits), double(expected_hits), 2 + 0.002 * double(expected_hits));
      for (const std::size_t leaf : got) EXPECT_TRUE(first_or_as_near.contains(leaf));
      std::size_t missing = 0;
      for (const std::size_t leaf : first) missing += got.contains(leaf) ? 0 : 1;
      EXPECT_LE(missing, 1 + first.size() / 100);
      for (const std::size_t leaf : got)
        EXPECT_EQ(layer.dirty[leaf / OctreeLayer::kLeavesPerRange], 1);
    }
  }
}

TEST(Octree, the_descent_paints_every_leaf_under_the_tool_that_is_seen) {
  const auto tree = build(small_geometry(), 6);
  const auto cells = tree.leaf_cells();
  for (const bool orthographic : {false, true}) {
    const auto dab = dab_from({0.5, -1.9, 2.6}, orthographic);
    const glm::dmat4 clip = dab.camera.projection * dab.camera.view;
    const auto window_of = [&](const glm::dvec3& p) {
      const glm::dvec4 c = clip * glm::dvec4(p, 1);
      return glm::dvec4((c.x / c.w * 0.5 + 0.5) * kWidth, (c.y / c.w * 0.5 + 0.5) * kHeight,
                        c.z / c.w * 0.5 + 0.5, c.w);
    };
    std::vector<float> depth(std::size_t{kWidth} * kHeight, 1.0f);
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        if (glm::length(glm::dvec2(x, y) - dab.center) > dab.radius_px + 2) continue;
        const Ray ray = ray_of(dab, x, y);
        const auto enter = entries(tree, cells, ray);
        const double nearest = *std::min_element(enter.begin(), enter.end());
        if (nearest < 1e9)
          depth[std::size_t((kHeight - 1 - y) * kWidth + x)] =
              float(window_of(ray.from + ray.way * nearest).z);
      }
    const auto copy = render::make_depth_copy(depth, kWidth, kHeight, 1);
    OctreeLayer layer(tree);
    const std::size_t count = paint_by_descent(tree, dab, copy, 2, layer);
    const auto got = painted(layer);
    EXPECT_EQ(count, got.size());
    std::size_t expected = 0, hidden = 0;
    const double tolerance = octree_depth_tolerance(tree, dab.camera);
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const auto p = window_of(glm::dvec3(tree.low()) +
                               (glm::dvec3(cells[i]) + 0.5) * double(tree.cell_side()));
      const double inside =
          dab.radius_px -
          glm::length(glm::dvec2(p) - glm::dvec2(dab.center.x, kHeight - dab.center.y));
      if (std::abs(inside) < 1e-3 || p.x < 0 || p.y < 0 || p.x >= kWidth || p.y >= kHeight)
        continue;
      const double before =
          depth[std::size_t(int(p.y) * kWidth + int(p.x))] - (p.z - tolerance / (p.w * p.w));
      const glm::dvec2 border = glm::abs(glm::dvec2(p) - glm::round(glm::dvec2(p)));
      if (std::abs(before) < 1e-5 || std::min(border.x, border.y) < 1e-3) continue;
      const bool seen = inside > 0 && before > 0;
      EXPECT_EQ(got.contains(i), seen) << "leaf " << i;
      expected += seen ? 1 : 0;
      hidden += inside > 0 && before < 0 ? 1 : 0;
    }
    EXPECT_GT(expected, 200u);
    EXPECT_GT(hidden, 50u)
        << "something under the tool must be hidden for the test to mean anything";
  }
}

TEST(Octree, one_that_does_not_fit_into_memory_is_refused_with_the_size_it_needs) {
  auto geometry = small_geometry();
  for (auto& index : geometry.indices) index %= 100;
  for (int i = 0; i < 9; ++i)
    geometry.indices.insert(geometry.indices.end(), geometry.indices.begin(),
                            geometry.indices.end());
  const auto tree = Octree::build(geometry, 15, 2);
  ASSERT_FALSE(tree.has_value());
  EXPECT_NE(tree.error().detail.find("GiB"), std::string::npos);
  EXPECT_FALSE(Octree::build(geometry, 0, 2).has_value());
  EXPECT_FALSE(Octree::build(geometry, 16, 2).has_value());
}

}  // namespace
}  // namespace strata::bench
