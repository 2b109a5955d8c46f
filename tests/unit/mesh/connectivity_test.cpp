// The half-edges of a mesh, and the repair of invalid meshes, compared with a mesh that OpenMesh
// builds.
#include "mesh/surface/connectivity.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <random>
#include <sstream>

#include "mesh/surface/boundary_loops.h"
#include "mesh/surface/face_neighbours.h"
#include "support/manifold_check.h"
#include "support/mesh_files.h"
#include "support/meshes.h"
#include "support/openmesh_oracle.h"

namespace {

using namespace strata;
using mesh::Connectivity;

std::string as_obj(const mesh::TriangleMesh& mesh) {
  std::ostringstream text;
  text.precision(17);
  for (const glm::dvec3& p : mesh.positions)
    text << "v " << p.x << ' ' << p.y << ' ' << p.z << '\n';
  for (std::size_t i = 0; i < mesh.triangles.size(); i += 3)
    text << "f " << mesh.triangles[i] + 1 << ' ' << mesh.triangles[i + 1] + 1 << ' '
         << mesh.triangles[i + 2] + 1 << '\n';
  return text.str();
}

mesh::TriangleMesh repaired(const mesh::TriangleMesh& mesh) {
  auto loaded = test::load_text(as_obj(mesh), "a.obj");
  EXPECT_TRUE(loaded) << (loaded ? "" : loaded.error().detail);
  return loaded ? std::move(loaded->mesh) : mesh::TriangleMesh{};
}

// Returns a mesh of few points and many triangles, with edges of many triangles, fins, and pieces
// that touch.
mesh::TriangleMesh tangle(unsigned seed) {
  std::mt19937 random(seed);
  const auto number = [&](unsigned end) { return static_cast<std::uint32_t>(random() % end); };
  mesh::TriangleMesh mesh;
  const std::uint32_t points = 4 + number(8), triangles = 2 + number(30);
  for (std::uint32_t i = 0; i < points; ++i)
    mesh.positions.push_back({number(1000), number(1000), number(1000)});
  for (std::uint32_t i = 0; i < 3 * triangles; ++i) mesh.triangles.push_back(number(points));
  return mesh;
}

void expect_accepted(const mesh::TriangleMesh& mesh) {
  const test::OpenMeshOracle oracle(mesh);
  EXPECT_TRUE(oracle.refused.empty()) << oracle.refused.size() << " of " << mesh.triangle_count()
                                      << " triangles, the first is " << oracle.refused.front();
}

void expect_equal_to_oracle(const mesh::TriangleMesh& mesh) {
  const test::OpenMeshOracle oracle(mesh);
  ASSERT_TRUE(oracle.refused.empty());
  const Connectivity ours(mesh.triangles, mesh.positions.size());
  ASSERT_EQ(ours.n_faces(), oracle.mesh.n_faces());
  ASSERT_EQ(ours.n_vertices(), oracle.mesh.n_vertices());
  EXPECT_EQ(ours.n_edges(), oracle.mesh.n_edges());
  const auto neighbours = mesh::face_neighbours(ours);
  for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
    const auto sides = ours.sides_of(t);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t corner = 3 * std::size_t{t} + k;
      ASSERT_EQ(ours.from(sides[k]), mesh.triangles[corner]);
      ASSERT_EQ(ours.to(sides[k]), mesh.triangles[3 * std::size_t{t} + (k + 1) % 3]);
      const auto theirs =
          oracle.mesh.find_halfedge(OpenMesh::VertexHandle(static_cast<int>(ours.from(sides[k]))),
                                    OpenMesh::VertexHandle(static_cast<int>(ours.to(sides[k]))));
      const auto other = oracle.mesh.opposite_face_handle(theirs);
      ASSERT_EQ(neighbours[corner],
                other.is_valid() ? static_cast<std::uint32_t>(other.idx()) : mesh::kNoTriangle);
      ASSERT_EQ(ours.is_open(sides[k]), !other.is_valid());
    }
  }
  for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
    const OpenMesh::VertexHandle vertex(static_cast<int>(v));
    ASSERT_EQ(ours.valence(vertex), oracle.mesh.valence(vertex)) << "the whole fan is reached";
    ASSERT_EQ(ours.is_boundary(vertex), oracle.mesh.is_boundary(vertex));
  }
}

TEST(Connectivity, openmesh_accepts_every_face_of_every_class_of_mesh_after_repair) {
  for (const auto& [name, mesh] : test::mesh_classes()) {
    SCOPED_TRACE(name);
    expect_accepted(repaired(mesh));
  }
}

TEST(Connectivity, openmesh_accepts_every_face_of_tangles_after_repair) {
  int repairs = 0;
  for (unsigned seed = 0; seed < 3000 && !HasFailure(); ++seed) {
    SCOPED_TRACE(seed);
    const mesh::TriangleMesh broken = tangle(seed);
    const auto loaded = test::load_text(as_obj(broken), "a.obj");
    if (!loaded) continue;  // no triangle has an area
    expect_accepted(loaded->mesh);
    const auto faults = test::manifold_faults(broken);
    repairs += faults.crowded_edges + faults.disagreements + faults.vertices_of_fans > 0 ? 1 : 0;
  }
  EXPECT_GT(repairs, 2000) << "most of them were no surface";
}

TEST(Connectivity, the_oracle_refuses_what_is_no_surface) {
  EXPECT_FALSE(test::OpenMeshOracle(test::grid_with_fins(12)).refused.empty());
  EXPECT_FALSE(test::OpenMeshOracle(test::flipped_and_duplicate(10)).refused.empty());
}

TEST(Connectivity, is_what_openmesh_builds_face_by_face) {
  for (const auto& [name, mesh] : test::mesh_classes()) {
    SCOPED_TRACE(name);
    expect_equal_to_oracle(repaired(mesh));
  }
}

TEST(Connectivity, many_triangles_around_one_vertex_take_no_longer_than_elsewhere) {
  // In this order, no triangle is next to its neighbor.
  constexpr std::uint32_t kCount = 400'000, kStep = 7919;
  std::vector<std::uint32_t> triangles;
  for (std::uint32_t i = 0; i < kCount; ++i) {
    const std::uint32_t at = static_cast<std::uint32_t>(std::uint64_t{i} * kStep % kCount);
    triangles.insert(triangles.end(), {0, 1 + at, 1 + (at + 1) % kCount});
  }
  const Connectivity connectivity(triangles, kCount + 1);
  EXPECT_EQ(connectivity.n_edges(), 2 * kCount);
  const auto loops = mesh::boundary_loops(connectivity);
  ASSERT_EQ(loops.size(), 1u);
  EXPECT_EQ(loops[0].size(), kCount);
}

TEST(Connectivity, an_edge_of_three_triangles_is_open_on_all_sides) {
  const std::vector<std::uint32_t> triangles{0, 1, 2, 1, 0, 3, 0, 1, 4};
  const Connectivity connectivity(triangles, 5);
  EXPECT_EQ(mesh::face_neighbours(connectivity), std::vector<std::uint32_t>(9, mesh::kNoTriangle));
}

TEST(BoundaryLoops, of_holes_are_counted_and_measured) {
  // A square of 20 × 20 cells with a side of 1. One cell and a block of 3 × 2 cells are missing.
  constexpr int kCells = 20;
  mesh::TriangleMesh grid = test::open_grid(kCells, 0);
  std::vector<std::uint32_t> triangles;
  const auto is_hole = [](int x, int y) {
    return (x == 4 && y == 4) || (x >= 10 && x < 13 && y >= 9 && y < 11);
  };
  for (std::size_t i = 0; i < grid.triangles.size(); i += 3) {
    glm::dvec3 middle(0);
    for (std::size_t k = 0; k < 3; ++k) middle += grid.positions[grid.triangles[i + k]] / 3.0;
    const glm::dvec3 low = grid.positions.front(), high = grid.positions.back();
    const glm::dvec3 cell = (middle - low) / (high - low) * double(kCells);
    if (is_hole(static_cast<int>(cell.x), static_cast<int>(cell.y))) continue;
    triangles.insert(triangles.end(), &grid.triangles[i], &grid.triangles[i] + 3);
  }
  const Connectivity connectivity(triangles, grid.positions.size());
  const double cell = (grid.positions.back().x - grid.positions.front().x) / kCells;
  std::vector<double> lengths;
  for (const auto& loop : mesh::boundary_loops(connectivity)) {
    double length = 0;
    for (std::size_t i = 0; i < loop.size(); ++i) {
      EXPECT_EQ(connectivity.to(loop[i]), connectivity.from(loop[(i + 1) % loop.size()]));
      EXPECT_TRUE(connectivity.is_open(loop[i]));
      length += glm::distance(grid.positions[connectivity.from(loop[i])],
                              grid.positions[connectivity.to(loop[i])]);
    }
    lengths.push_back(length / cell);
  }
  std::ranges::sort(lengths);
  ASSERT_EQ(lengths.size(), 3u);
  EXPECT_NEAR(lengths[0], 4, 1e-9);
  EXPECT_NEAR(lengths[1], 10, 1e-9);
  EXPECT_NEAR(lengths[2], 4.0 * kCells, 1e-9);
}

TEST(BoundaryLoops, hold_every_open_side_once) {
  for (const auto& [name, broken] : test::mesh_classes()) {
    SCOPED_TRACE(name);
    const mesh::TriangleMesh mesh = repaired(broken);
    const Connectivity connectivity(mesh.triangles, mesh.positions.size());
    std::vector<int> sides;
    for (const auto& loop : mesh::boundary_loops(connectivity))
      for (const auto side : loop) sides.push_back(side.idx());
    std::ranges::sort(sides);
    EXPECT_TRUE(std::ranges::adjacent_find(sides) == sides.end());
    EXPECT_EQ(sides.size(), test::manifold_faults(mesh).boundary_edges);
  }
}

TEST(BoundaryLoops, pieces_that_touch_in_a_vertex_have_loops_of_their_own) {
  const std::vector<std::uint32_t> triangles{0, 1, 2, 0, 3, 4};
  const Connectivity connectivity(triangles, 5);
  const auto loops = mesh::boundary_loops(connectivity);
  ASSERT_EQ(loops.size(), 2u);
  EXPECT_EQ(loops[0].size(), 3u);
  EXPECT_EQ(loops[1].size(), 3u);
}

}  // namespace
