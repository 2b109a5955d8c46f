// Flat pieces stay whole. Also tests atlases with low coverage.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "mesh/atlas/atlas.h"
#include "mesh/atlas/charts.h"
#include "mesh/atlas/flat_pieces.h"
#include "mesh/io/load.h"
#include "mesh/surface/uv_islands.h"
#include "strata_dirs.h"
#include "support/meshes.h"

namespace strata::mesh {
namespace {

Atlas unwrapped(const TriangleMesh& mesh, int resolution = 512) {
  Progress progress;
  auto atlas = make_atlas(mesh, resolution, progress);
  EXPECT_TRUE(atlas) << (atlas ? "" : atlas.error().detail);
  return atlas ? std::move(*atlas) : Atlas{};
}

std::vector<std::uint32_t> islands_of(const TriangleMesh& mesh, const Atlas& atlas) {
  std::vector<std::uint32_t> indices;
  const auto count = weld_corners(mesh.triangles, atlas.corner_uvs, mesh.positions.size(), indices);
  return find_islands(indices, count).of_triangle;
}

glm::dvec3 normal_of(const TriangleMesh& mesh, std::size_t t) {
  const auto a = mesh.positions[mesh.triangles[3 * t]];
  return glm::normalize(glm::cross(mesh.positions[mesh.triangles[3 * t + 1]] - a,
                                   mesh.positions[mesh.triangles[3 * t + 2]] - a));
}

// Expects triangles that share an edge and a plane to be in the same island. Tests all pairs by
// brute force.
void expect_planes_in_one_chart(const TriangleMesh& mesh, const Atlas& atlas) {
  const auto islands = islands_of(mesh, atlas);
  int pairs = 0;
  for (std::size_t a = 0; a < mesh.triangle_count(); ++a)
    for (std::size_t b = a + 1; b < mesh.triangle_count(); ++b) {
      int shared = 0;
      for (int k = 0; k < 9; ++k)
        shared += mesh.triangles[3 * a + k / 3] == mesh.triangles[3 * b + k % 3];
      if (shared < 2 || glm::dot(normal_of(mesh, a), normal_of(mesh, b)) < 1 - 1e-12) continue;
      ++pairs;
      ASSERT_EQ(islands[a], islands[b]) << "triangles " << a << " and " << b;
    }
  EXPECT_GT(pairs, 0);
}

TEST(mesh_atlas_flat, connected_faces_of_one_plane_are_one_chart) {
  for (const auto& mesh :
       {test::cubes(20), test::gear(24), test::flat_ring(66), test::strips(9, 30)})
    expect_planes_in_one_chart(mesh, unwrapped(mesh));
}

TEST(mesh_atlas_flat, a_cube_is_six_charts) {
  EXPECT_EQ(unwrapped(test::cubes(1)).report.charts, 6);
  EXPECT_EQ(unwrapped(test::cubes(30)).report.charts, 180);
}

TEST(mesh_atlas_flat, a_plane_larger_than_the_window_in_which_charts_grow_is_one_chart) {
  const Atlas atlas = unwrapped(test::flat_ring(66));
  EXPECT_EQ(atlas.report.charts, 1);
  EXPECT_NEAR(atlas.report.stretch_p99, 1, 0.01);
}

FlatPieces flat_pieces_of(const TriangleMesh& mesh) {
  const UnitMesh unit = to_unit_mesh(mesh);
  return make_chart_surface(unit, 2).flat;
}

TEST(mesh_atlas_flat, a_curved_surface_has_no_flat_piece) {
  // Each cell of the grid is flat, and is tilted by less than a degree to the next cell.
  EXPECT_EQ(flat_pieces_of(test::sphere(400)).count(), 0u);
}

TEST(mesh_atlas_flat,
     faces_of_a_coarse_or_noisy_surface_are_flat_pieces_only_where_they_lie_in_one_plane) {
  // The cells of a coarse sphere are planes between creases. All triangles except those at the
  // poles are in pieces of two.
  const FlatPieces coarse = flat_pieces_of(test::sphere(40));
  EXPECT_EQ(coarse.count(), 40u * 18);
  EXPECT_EQ(coarse.faces.size(), 2u * 40 * 18);
  // With noise, two faces are in the same plane only by chance.
  const TriangleMesh noisy = test::sphere(60, 0.08);
  const FlatPieces few = flat_pieces_of(noisy);
  EXPECT_LT(few.faces.size(), noisy.triangle_count() / 100);
  for (std::uint32_t piece = 0; piece < few.count(); ++piece)
    for (const auto face : few.faces_of(piece))
      EXPECT_GT(glm::dot(normal_of(noisy, face), glm::dvec3(few.normals[piece])), 0.99999);
}

TEST(mesh_atlas_flat, long_strips_do_not_keep_all_else_small) {
  // Without special treatment, strips with a length of 150 would limit the scale to a tenth of the
  // atlas.
  TriangleMesh mesh = test::strips(6, 150);
  const auto offset = static_cast<std::uint32_t>(mesh.positions.size());
  const auto others = test::transformed(test::cubes(4), 8, {0, 200, 0});
  mesh.positions.insert(mesh.positions.end(), others.positions.begin(), others.positions.end());
  for (const auto vertex : others.triangles) mesh.triangles.push_back(vertex + offset);
  const Atlas atlas = unwrapped(mesh, 1024);
  const auto& report = atlas.report;
  EXPECT_GE(report.coverage, 0.35);
  EXPECT_LE(report.texel_area_max, 3 * surface_area(mesh) / (report.coverage * 1024 * 1024));
  EXPECT_EQ(report.overlap, 0);
}

TEST(mesh_atlas_flat, an_atlas_that_uses_little_says_why_and_one_that_uses_much_does_not) {
  const auto codes = [](const Atlas& atlas) {
    std::set<std::string> found;
    for (const auto& limit : atlas.report.limits) {
      found.insert(limit.code);
      EXPECT_FALSE(limit.text.empty());
    }
    return found;
  };
  EXPECT_THAT(codes(unwrapped(test::flat_ring(66))), testing::Contains("hollow_charts"));
  EXPECT_THAT(codes(unwrapped(test::separate_triangles(3000), 512)),
              testing::Contains("many_charts"));
  EXPECT_THAT(codes(unwrapped(test::strips(1, 500))), testing::Contains("long_triangles"));
  const Atlas cubes = unwrapped(test::cubes(20));
  EXPECT_GE(cubes.report.coverage, 0.6);
  EXPECT_THAT(cubes.report.limits, testing::IsEmpty());
}

TEST(mesh_atlas_flat, files_of_other_projects_use_their_texels) {
  struct Expected {
    const char* file;
    int most_charts;
    double coverage;
  };
  const std::filesystem::path peers = std::filesystem::path(STRATA_TEST_DATA) / "peers";
  int found = 0;
  const std::vector<Expected> all{{"concave_polygon.obj", 1, 0},
                                  {"hundred_cubes.obj", 600, 0.6},
                                  {"gearwheel.ascii.stl", 400, 0.6},
                                  {"goslar32k.obj", 1000, 0.6},
                                  {"lamp_post.glb", 600, 0.6}};
  for (const auto& [file, most_charts, coverage] : all) {
    if (!std::filesystem::exists(peers / file)) continue;
    ++found;
    Progress progress;
    const auto scan = load_mesh(peers / file, file, progress);
    ASSERT_TRUE(scan) << file;
    const Atlas atlas = unwrapped(scan->mesh, 2048);
    const auto& report = atlas.report;
    EXPECT_LE(report.charts, most_charts) << file;
    EXPECT_GE(report.coverage, coverage) << file;
    EXPECT_EQ(report.overlap, 0) << file;
    EXPECT_LE(report.texel_area_max, 3 * surface_area(scan->mesh) / (report.coverage * 2048 * 2048))
        << file;
    EXPECT_LE(report.stretch_mean, 1.35) << file;
  }
  if (found == 0) GTEST_SKIP() << "no files at " << peers;
}

}  // namespace
}  // namespace strata::mesh
