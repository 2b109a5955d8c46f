#include "mesh/atlas/atlas.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <string>
#include <thread>

#include "domain/scene/model_measures.h"
#include "mesh/atlas/atlas_report.h"
#include "mesh/surface/geometry.h"
#include "mesh/surface/uv_islands.h"
#include "mesh/texels/surface_map.h"
#include "strata_dirs.h"
#include "support/meshes.h"
#include "support/scan_atlas.h"

namespace strata::mesh {
namespace {

constexpr int kLowest = 256;

// Counts how often each texel center is covered. This second implementation of OpenGL's rule tests
// each texel with integers.
std::vector<int> owners_by_brute_force(const TriangleMesh& mesh, const Atlas& atlas,
                                       int resolution) {
  std::vector<int> owners(std::size_t(resolution) * resolution, 0);
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    std::int64_t x[3], y[3];
    for (int k = 0; k < 3; ++k) {
      x[k] = std::lrint(double(atlas.corner_uvs[3 * t + k].x) * resolution * 256);
      y[k] = std::lrint(double(atlas.corner_uvs[3 * t + k].y) * resolution * 256);
    }
    const auto side_of = [&](int a, int b, std::int64_t px, std::int64_t py) {
      return (x[b] - x[a]) * (py - y[a]) - (y[b] - y[a]) * (px - x[a]);
    };
    const std::int64_t area = side_of(0, 1, x[2], y[2]);
    if (area == 0) continue;
    const auto [left, right] = std::minmax({x[0], x[1], x[2]});
    const auto [bottom, top] = std::minmax({y[0], y[1], y[2]});
    for (int row = int(bottom / 256); row <= std::min<int>(int(top / 256), resolution - 1); ++row)
      for (int column = int(left / 256); column <= std::min<int>(int(right / 256), resolution - 1);
           ++column) {
        const std::int64_t px = column * 256 + 128, py = row * 256 + 128;
        bool covered = true;
        for (int k = 0; k < 3; ++k) {
          const int a = area > 0 ? k : (k + 1) % 3, b = area > 0 ? (k + 1) % 3 : k;
          const std::int64_t s = side_of(a, b, px, py);
          const bool owns = y[b] < y[a] || (y[b] == y[a] && x[b] > x[a]);
          covered &= s > 0 || (s == 0 && owns);
        }
        owners[std::size_t(row) * resolution + column] += covered;
      }
  }
  return owners;
}

std::vector<std::uint32_t> islands_of(const TriangleMesh& mesh, const Atlas& atlas) {
  std::vector<std::uint32_t> indices;
  const auto count = weld_corners(mesh.triangles, atlas.corner_uvs, mesh.positions.size(), indices);
  return find_islands(indices, count).of_triangle;
}

double uv_area(const Atlas& atlas, std::size_t t) {
  const glm::dvec2 a = atlas.corner_uvs[3 * t], b = atlas.corner_uvs[3 * t + 1],
                   c = atlas.corner_uvs[3 * t + 2];
  return std::abs((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)) / 2;
}

double area_of(const TriangleMesh& mesh, std::size_t t) {
  const auto a = mesh.positions[mesh.triangles[3 * t]];
  return glm::length(glm::cross(mesh.positions[mesh.triangles[3 * t + 1]] - a,
                                mesh.positions[mesh.triangles[3 * t + 2]] - a)) /
         2;
}

class EveryMeshClass : public testing::TestWithParam<test::NamedMesh> {
 protected:
  const TriangleMesh& mesh() const { return GetParam().mesh; }
  Atlas unwrap() {
    Progress progress;
    auto atlas = make_atlas(mesh(), kLowest, progress);
    EXPECT_TRUE(atlas.has_value()) << (atlas ? "" : atlas.error().detail);
    return atlas ? *atlas : Atlas{};
  }
  // Returns an atlas that is made once. All tests that only read it share it.
  const Atlas& unwrapped() {
    static std::map<std::string, Atlas> atlases;
    const auto found = atlases.find(GetParam().name);
    return found != atlases.end() ? found->second : atlases[GetParam().name] = unwrap();
  }
};
INSTANTIATE_TEST_SUITE_P(mesh_atlas, EveryMeshClass, testing::ValuesIn(test::mesh_classes()),
                         [](const auto& instance) { return instance.param.name; });

TEST_P(EveryMeshClass, has_all_its_corners_inside_the_unit_square) {
  const Atlas& atlas = unwrapped();
  ASSERT_EQ(atlas.corner_uvs.size(), mesh().triangles.size());
  for (const auto uv : atlas.corner_uvs) {
    ASSERT_TRUE(uv.x >= 0 && uv.x <= 1 && uv.y >= 0 && uv.y <= 1) << uv.x << " " << uv.y;
  }
}

TEST_P(EveryMeshClass, has_no_texel_with_two_owners_up_to_four_times_the_lowest_resolution) {
  const Atlas& atlas = unwrapped();
  for (const int resolution : {kLowest, 2 * kLowest, 4 * kLowest})
    EXPECT_THAT(owners_by_brute_force(mesh(), atlas, resolution), testing::Each(testing::Le(1)))
        << resolution;
}

TEST_P(EveryMeshClass, reports_the_coverage_that_a_count_of_texels_finds) {
  const Atlas& atlas = unwrapped();
  const auto owners = owners_by_brute_force(mesh(), atlas, kLowest);
  const auto covered = std::count_if(owners.begin(), owners.end(), [](int n) { return n > 0; });
  EXPECT_DOUBLE_EQ(atlas.report.coverage, double(covered) / (kLowest * kLowest));
  EXPECT_EQ(atlas.report.overlap, 0);
  EXPECT_EQ(atlas.report.source, "made");
  EXPECT_EQ(atlas.report.lowest_resolution, kLowest);
}

TEST_P(EveryMeshClass, gives_every_triangle_with_an_area_a_footprint) {
  const Atlas& atlas = unwrapped();
  double total = 0, total_uv = 0;
  for (std::size_t t = 0; t < mesh().triangle_count(); ++t)
    total += area_of(mesh(), t), total_uv += uv_area(atlas, t);
  ASSERT_GT(total_uv, 0);
  for (std::size_t t = 0; t < mesh().triangle_count(); ++t) {
    const double relative = area_of(mesh(), t) / total;
    if (relative < 1e-9) continue;
    EXPECT_GT(uv_area(atlas, t) / total_uv, relative / 10) << "triangle " << t;
  }
}

TEST_P(EveryMeshClass, keeps_two_empty_texels_between_charts) {
  const Atlas& atlas = unwrapped();
  const auto islands = islands_of(mesh(), atlas);
  EXPECT_EQ(atlas.report.charts, 1 + int(*std::max_element(islands.begin(), islands.end())));
  // Texels that edges touch can be the nearest ones to another chart.
  constexpr std::uint32_t kFree = 0xffffffffu;
  std::vector<std::uint32_t> touched(kLowest * kLowest, kFree);
  const auto touch = [&](glm::dvec2 p, std::uint32_t island) {
    const auto x = std::min(int(p.x), kLowest - 1), y = std::min(int(p.y), kLowest - 1);
    auto& texel = touched[y * kLowest + x];
    ASSERT_TRUE(texel == kFree || texel == island) << x << " " << y;
    texel = island;
  };
  for (std::size_t t = 0; t < mesh().triangle_count(); ++t)
    for (int k = 0; k < 3; ++k) {
      const glm::dvec2 a = glm::dvec2(atlas.corner_uvs[3 * t + k]) * double(kLowest);
      const glm::dvec2 b = glm::dvec2(atlas.corner_uvs[3 * t + (k + 1) % 3]) * double(kLowest);
      const int steps = 1 + int(8 * glm::length(b - a));
      for (int i = 0; i <= steps; ++i) touch(a + (b - a) * (double(i) / steps), islands[t]);
    }
  for (int y = 0; y < kLowest; ++y)
    for (int x = 0; x < kLowest; ++x) {
      const auto island = touched[y * kLowest + x];
      if (island == kFree) continue;
      for (int dy = -2; dy <= 2; ++dy)
        for (int dx = -2; dx <= 2; ++dx) {
          if (x + dx < 0 || y + dy < 0 || x + dx >= kLowest || y + dy >= kLowest) continue;
          const auto near = touched[(y + dy) * kLowest + x + dx];
          ASSERT_TRUE(near == kFree || near == island) << x << " " << y;
        }
    }
}

TEST_P(EveryMeshClass, is_unwrapped_the_same_every_time) {
  EXPECT_EQ(unwrap().corner_uvs, unwrapped().corner_uvs);
}

TEST(mesh_atlas, does_not_depend_on_scale_or_place) {
  const auto plain = test::sphere(40);
  Progress progress;
  const auto expected = make_atlas(plain, kLowest, progress);
  ASSERT_TRUE(expected);
  for (const auto& moved :
       {test::transformed(plain, 1e-9, {0, 0, 0}), test::transformed(plain, 1e9, {0, 0, 0}),
        test::transformed(plain, 0.05, {433210.12, 4581234.57, 612.25})}) {
    const auto atlas = make_atlas(moved, kLowest, progress);
    ASSERT_TRUE(atlas);
    EXPECT_EQ(atlas->report.charts, expected->report.charts);
    EXPECT_NEAR(atlas->report.coverage, expected->report.coverage, 0.02);
    EXPECT_NEAR(atlas->report.stretch_mean, expected->report.stretch_mean, 0.01);
  }
}

TEST(mesh_atlas, reports_the_largest_texel_in_the_units_of_the_file) {
  Progress progress;
  const auto small = make_atlas(test::sphere(40), kLowest, progress);
  const auto large =
      make_atlas(test::transformed(test::sphere(40), 1024, {0, 0, 0}), kLowest, progress);
  ASSERT_TRUE(small && large);
  EXPECT_NEAR(large->report.texel_area_max / small->report.texel_area_max, 1024.0 * 1024.0, 1024);
  const double mean = 4 * M_PI / (small->report.coverage * kLowest * kLowest);
  EXPECT_GT(small->report.texel_area_max, mean);
  EXPECT_LT(small->report.texel_area_max, 3 * mean);
}

TEST(mesh_atlas, reports_how_much_surface_texels_hold_at_each_resolution) {
  Progress progress;
  const auto mesh = test::sphere(40);
  const auto atlas = make_atlas(mesh, kLowest, progress);
  ASSERT_TRUE(atlas);
  const auto& sizes = atlas->report.texel_sizes;
  ASSERT_EQ(sizes.size(), 3u);
  EXPECT_EQ(sizes[0].area_max, atlas->report.texel_area_max);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(sizes[i].resolution, kLowest << i);
    EXPECT_NEAR(sizes[i].area_mean * std::pow(4, i), sizes[0].area_mean, 1e-9);
    EXPECT_GT(sizes[i].area_max, sizes[i].area_mean);
    EXPECT_LT(sizes[i].area_max, 3 * sizes[i].area_mean);
  }
  double uv_sum = 0;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) uv_sum += uv_area(*atlas, t);
  EXPECT_NEAR(sizes[0].area_mean * uv_sum * kLowest * kLowest, surface_area(mesh), 1e-6);
}

// The limits of functions along the surface rely on it (query/regions/neighborhood_limits).
TEST(mesh_atlas, reports_the_mean_size_of_the_texels_on_the_surface_to_1_percent) {
  const auto expect_same = [](const TriangleMesh& mesh, const Atlas& atlas) {
    const Geometry geometry = build_geometry(mesh, atlas);
    for (const auto& size : atlas.report.texel_sizes) {
      Progress progress;
      const auto map = bake_surface_map(geometry, size.resolution, progress);
      ASSERT_TRUE(map);
      const double of_map = std::sqrt(map->area_total / double(map->surface_texels));
      EXPECT_NEAR(*reported_texel_size(atlas.report, size.resolution) / of_map, 1, 0.01)
          << size.resolution;
    }
  };
  Progress progress;
  const auto sphere = test::sphere(40);
  const auto made = make_atlas(sphere, kLowest, progress);
  ASSERT_TRUE(made);
  expect_same(sphere, *made);
  const auto pieces = test::separate_triangles(100);
  const auto of_pieces = make_atlas(pieces, 512, progress);
  ASSERT_TRUE(of_pieces);
  expect_same(pieces, *of_pieces);
  for (const char* name : {"gargoyle_3dhop_50k_colour_normals.ply", "vessel_jug_seavase_35k.ply"}) {
    if (!std::filesystem::exists(std::filesystem::path(STRATA_TEST_DATA) / name)) continue;
    const auto& scan = test::scan_with_made_atlas(name);
    ASSERT_TRUE(scan) << scan.error().detail;
    expect_same(scan->mesh, scan->atlas);
  }
}

TEST(mesh_atlas, the_largest_texel_of_an_even_sheet_is_any_texel) {
  // The sheet has area 1. Its texture coordinates first fill [0.05, 0.95]², then half of that.
  const auto mesh = test::open_grid(10, 0);
  ASSERT_NEAR(surface_area(mesh), 1, 1e-6);
  const double side = 1 / (0.9 * 100);
  EXPECT_NEAR(largest_texel_area(mesh, mesh.corner_uvs, 100), side * side, 1e-3 * side * side);
  auto uvs = mesh.corner_uvs;
  for (auto& uv : uvs) uv = {uv.x, uv.y / 2};
  EXPECT_NEAR(largest_texel_area(mesh, uvs, 100), 2 * side * side, 2e-3 * side * side);
}

TEST(mesh_atlas, lays_a_flat_sheet_out_without_stretch) {
  Progress progress;
  const auto atlas = make_atlas(test::open_grid(20, 0), kLowest, progress);
  ASSERT_TRUE(atlas);
  EXPECT_NEAR(atlas->report.stretch_mean, 1, 0.01);
  EXPECT_NEAR(atlas->report.stretch_p99, 1, 0.1);
}

TEST(mesh_atlas, stops_when_cancelled) {
  Progress progress;
  progress.cancel();
  const auto atlas = make_atlas(test::sphere(40), kLowest, progress);
  ASSERT_FALSE(atlas);
  EXPECT_EQ(atlas.error().code, ErrorCode::cancelled);
}

TEST(mesh_atlas, refuses_more_pieces_than_texels_can_hold_apart) {
  Progress progress;
  const auto atlas = make_atlas(test::separate_triangles(3000), 128, progress);
  ASSERT_FALSE(atlas);
  EXPECT_EQ(atlas.error().code, ErrorCode::invalid);
  EXPECT_THAT(atlas.error().detail, testing::HasSubstr("higher minimum resolution"));
}

TEST(mesh_atlas, refuses_a_soup_of_faces_before_it_tries_to_pack_it) {
  // To pack so many triangles would take minutes. But the atlas has too few texels for them, and
  // the code detects this before it packs.
  Progress progress;
  const auto atlas = make_atlas(test::separate_triangles(200'000), 1024, progress);
  ASSERT_FALSE(atlas);
  EXPECT_EQ(atlas.error().code, ErrorCode::invalid);
  EXPECT_THAT(atlas.error().detail, testing::HasSubstr("200000 separate pieces"));
}

TEST(mesh_atlas, stops_packing_when_cancelled) {
  Progress progress;
  std::thread canceller([&] {
    while (progress.message() != "Packing the charts") std::this_thread::yield();
    progress.cancel();
  });
  const auto atlas = make_atlas(test::separate_triangles(200'000), 2048, progress);
  canceller.join();
  ASSERT_FALSE(atlas);
  EXPECT_EQ(atlas.error().code, ErrorCode::cancelled);
}

TEST(mesh_atlas, refuses_a_mesh_without_area) {
  TriangleMesh line;
  line.positions = {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}};
  line.triangles = {0, 1, 2};
  Progress progress;
  const auto atlas = make_atlas(line, kLowest, progress);
  ASSERT_FALSE(atlas);
  EXPECT_EQ(atlas.error().code, ErrorCode::invalid);
}

TEST(mesh_atlas, of_real_scans_uses_most_texels_with_little_stretch) {
  const std::filesystem::path data = STRATA_TEST_DATA;
  int found = 0;
  for (const char* name : {"statue_nefertiti_70k.ply", "gargoyle_3dhop_50k_colour_normals.ply",
                           "vessel_lekythos_gigamesh_15k.ply", "vessel_jug_seavase_35k.ply"}) {
    if (!std::filesystem::exists(data / name)) continue;
    ++found;
    const auto& scan = test::scan_with_made_atlas(name);
    ASSERT_TRUE(scan) << scan.error().detail;
    EXPECT_GE(scan->atlas.report.coverage, 0.6) << name;
    EXPECT_LE(scan->atlas.report.stretch_mean, 1.35) << name;
    EXPECT_EQ(scan->atlas.report.overlap, 0) << name;
    const auto& report = scan->atlas.report;
    const double texels = report.coverage * report.lowest_resolution * report.lowest_resolution;
    EXPECT_LE(report.texel_area_max, 3 * surface_area(scan->mesh) / texels) << name;
  }
  if (found == 0) GTEST_SKIP() << "no scans at " << data;
}

}  // namespace
}  // namespace strata::mesh
