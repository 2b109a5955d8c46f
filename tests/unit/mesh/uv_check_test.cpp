#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <limits>

#include "mesh/atlas/atlas.h"
#include "mesh/io/load.h"
#include "strata_dirs.h"
#include "support/meshes.h"

namespace strata::mesh {
namespace {

using testing::HasSubstr;

Result<Atlas> keep(const TriangleMesh& mesh, int lowest = 512) {
  Progress progress;
  return keep_uvs(mesh, lowest, progress);
}

TEST(mesh_uv_check, keeps_charts_that_lie_apart) {
  const auto cube = test::cube_with_face_charts();
  const auto atlas = keep(cube);
  ASSERT_TRUE(atlas) << atlas.error().detail;
  EXPECT_EQ(atlas->corner_uvs, cube.corner_uvs);
  EXPECT_EQ(atlas->report.source, "file");
  EXPECT_EQ(atlas->report.charts, 6);
  EXPECT_EQ(atlas->report.overlap, 0);
  EXPECT_NEAR(atlas->report.coverage, 6 * 0.3 * 0.3, 0.01);
  EXPECT_NEAR(atlas->report.stretch_mean, 1, 1e-4);
  EXPECT_NEAR(atlas->report.texel_area_max, 1 / (0.3 * 0.3 * 512 * 512), 1e-7);
}

TEST(mesh_uv_check, counts_no_overlap_on_shared_edges) {
  const auto atlas = keep(test::open_grid(64));
  ASSERT_TRUE(atlas) << atlas.error().detail;
  EXPECT_EQ(atlas->report.overlap, 0);
  EXPECT_EQ(atlas->report.charts, 1);
}

TEST(mesh_uv_check, refuses_a_mesh_without_uvs) {
  const auto atlas = keep(test::sphere(20));
  ASSERT_FALSE(atlas);
  EXPECT_THAT(atlas.error().detail, HasSubstr("no texture coordinates"));
}

TEST(mesh_uv_check, refuses_uvs_that_are_not_finite) {
  auto cube = test::cube_with_face_charts();
  cube.corner_uvs[5].x = std::numeric_limits<float>::quiet_NaN();
  cube.corner_uvs[6].y = std::numeric_limits<float>::infinity();
  const auto atlas = keep(cube);
  ASSERT_FALSE(atlas);
  EXPECT_THAT(atlas.error().detail, HasSubstr("of 2 of 12 triangles are not finite numbers"));
}

TEST(mesh_uv_check, refuses_uvs_outside_the_unit_square) {
  auto cube = test::cube_with_face_charts();
  for (auto& uv : cube.corner_uvs) uv.x *= 3;
  const auto atlas = keep(cube);
  ASSERT_FALSE(atlas);
  EXPECT_THAT(atlas.error().detail, HasSubstr("outside the unit square"));
}

TEST(mesh_uv_check, takes_what_rounding_puts_outside_as_the_border) {
  auto cube = test::cube_with_face_charts();
  for (auto& uv : cube.corner_uvs) uv.x -= 0.01f;
  cube.corner_uvs[0].x = -1e-6f;
  const auto atlas = keep(cube);
  ASSERT_TRUE(atlas) << atlas.error().detail;
  EXPECT_EQ(atlas->corner_uvs[0].x, 0);
}

TEST(mesh_uv_check, refuses_charts_that_overlap) {
  auto cube = test::cube_with_face_charts();
  for (int corner = 0; corner < 6; ++corner) cube.corner_uvs[corner] = cube.corner_uvs[6 + corner];
  const auto atlas = keep(cube);
  ASSERT_FALSE(atlas);
  EXPECT_THAT(atlas.error().detail, HasSubstr("overlap"));
}

TEST(mesh_uv_check, keeps_and_reports_a_little_overlap) {
  auto cube = test::cube_with_face_charts();
  // The second face overlaps the rim of the first by one thousandth of a face.
  for (int corner = 6; corner < 12; ++corner) cube.corner_uvs[corner].x -= 0.03f + 0.0006f;
  const auto atlas = keep(cube, 2048);
  ASSERT_TRUE(atlas) << atlas.error().detail;
  EXPECT_GT(atlas->report.overlap, 0.0001);
  EXPECT_LT(atlas->report.overlap, 0.001);
}

TEST(mesh_uv_check, refuses_surface_without_area_in_the_texture) {
  auto cube = test::cube_with_face_charts();
  for (const int corner : {0, 3, 6}) cube.corner_uvs[corner + 2] = cube.corner_uvs[corner + 1];
  const auto atlas = keep(cube);
  ASSERT_FALSE(atlas);
  EXPECT_THAT(atlas.error().detail, HasSubstr("have no area in the texture"));
}

// Expects that only the faulty face is moved, at no less than half the scale of the rest, and that
// all other faces keep their position.
void expect_one_moved(const TriangleMesh& mesh, std::uint32_t face, const std::string& why) {
  const auto atlas = keep(mesh, 1024);
  ASSERT_TRUE(atlas) << atlas.error().detail;
  EXPECT_EQ(atlas->report.source, "file");
  EXPECT_EQ(atlas->moved, std::vector<std::uint32_t>{face});
  EXPECT_EQ(atlas->report.overlap, 0);
  EXPECT_LT(atlas->report.stretch_p99, 4.5);
  for (std::size_t corner = 0; corner < mesh.corner_uvs.size(); ++corner) {
    if (corner / 3 != face) {
      EXPECT_EQ(atlas->corner_uvs[corner], mesh.corner_uvs[corner]) << corner;
    }
    const glm::vec2 uv = atlas->corner_uvs[corner];
    EXPECT_TRUE(uv.x >= 0 && uv.y >= 0 && uv.x <= 1 && uv.y <= 1) << corner;
  }
  ASSERT_EQ(atlas->repairs.size(), 1u);
  EXPECT_THAT(atlas->repairs[0].what, HasSubstr(why));
  EXPECT_EQ(atlas->repairs[0].count, 1u);
}

TEST(mesh_uv_check, one_faulty_face_is_moved_and_the_rest_stays) {
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  const auto with = [](std::initializer_list<glm::vec2> uvs, int face) {
    auto cube = test::cube_with_face_charts();
    int corner = 3 * face;
    for (const glm::vec2 uv : uvs) cube.corner_uvs[corner++] = uv;
    return cube;
  };
  expect_one_moved(with({{kNone, 0}, {kNone, kNone}, {0, 0}}, 4), 4, "are not finite numbers");
  expect_one_moved(with({{0.5f, 0.5f}, {0.5f, 0.5f}, {0.5f, 0.5f}}, 11), 11, "have no area");
  expect_one_moved(with({{1.5f, 0.5f}, {1.8f, 0.5f}, {1.8f, 0.8f}}, 0), 0,
                   "lie outside the unit square");
  // This face overlaps nearly all others, although it is the first face of the file.
  expect_one_moved(with({{0, 0}, {1, 0}, {0.5f, 1}}, 0), 0, "overlap others");
}

TEST(mesh_uv_check, where_no_texel_is_free_the_rest_makes_room) {
  auto grid = test::open_grid(16);
  for (auto& uv : grid.corner_uvs) uv = (uv - 0.05f) / 0.9f;  // the whole square
  grid.positions.push_back({0.03, 0.03, 0.2});
  grid.triangles.insert(grid.triangles.end(),
                        {0, 1, static_cast<std::uint32_t>(grid.positions.size()) - 1});
  grid.corner_uvs.insert(grid.corner_uvs.end(), 3, glm::vec2(2));
  const auto atlas = keep(grid, 1024);
  ASSERT_TRUE(atlas) << atlas.error().detail;
  EXPECT_EQ(atlas->moved, std::vector<std::uint32_t>{512});
  EXPECT_LT(atlas->kept_scale, 1);
  EXPECT_EQ(atlas->corner_uvs[0], grid.corner_uvs[0] * atlas->kept_scale);
  EXPECT_EQ(atlas->report.overlap, 0);
  ASSERT_EQ(atlas->repairs.size(), 2u);
  EXPECT_THAT(atlas->repairs[1].what, HasSubstr("make room"));
}

TEST(mesh_uv_check, a_fault_of_a_face_without_surface_costs_nothing) {
  auto cube = test::cube_with_face_charts();
  cube.triangles.insert(cube.triangles.end(), {0, 1, 1});
  cube.corner_uvs.insert(cube.corner_uvs.end(), 3,
                         glm::vec2(std::numeric_limits<float>::infinity()));
  const auto atlas = keep(cube);
  ASSERT_TRUE(atlas) << atlas.error().detail;
  EXPECT_TRUE(atlas->moved.empty());
  EXPECT_TRUE(atlas->repairs.empty());
}

TEST(mesh_uv_check, stops_when_cancelled) {
  Progress progress;
  progress.cancel();
  const auto atlas = keep_uvs(test::cube_with_face_charts(), 512, progress);
  ASSERT_FALSE(atlas);
  EXPECT_EQ(atlas.error().code, ErrorCode::cancelled);
}

class ScanUvs : public testing::Test {
 protected:
  Result<Atlas> keep_of(const std::string& name) {
    const auto file = std::filesystem::path(STRATA_TEST_DATA) / name;
    Progress progress;
    const auto scan = load_mesh(file, name, progress);
    EXPECT_TRUE(scan.has_value()) << (scan ? "" : scan.error().detail);
    return keep_uvs(scan->mesh, 2048, progress);
  }
  void SetUp() override {
    if (!std::filesystem::exists(STRATA_TEST_DATA))
      GTEST_SKIP() << "no scans at " << STRATA_TEST_DATA;
  }
};

TEST_F(ScanUvs, of_the_mask_are_kept_and_their_overlap_is_reported) {
  const auto atlas = keep_of("mask_bali/mask.obj");
  ASSERT_TRUE(atlas) << atlas.error().detail;
  EXPECT_EQ(atlas->report.charts, 1272);
  EXPECT_NEAR(atlas->report.overlap, 0.0006, 0.0001);
  EXPECT_NEAR(atlas->report.coverage, 0.535, 0.005);
}

TEST_F(ScanUvs, that_are_mirrored_tiled_or_spread_over_tiles_are_refused) {
  for (const char* name : {"nasty/n06_uv_mirrored_overlap.obj", "nasty/n07_uv_tiling_outside.obj",
                           "nasty/n08_udim_4tiles_4materials.obj"})
    EXPECT_FALSE(keep_of(name).has_value()) << name;
}

}  // namespace
}  // namespace strata::mesh
