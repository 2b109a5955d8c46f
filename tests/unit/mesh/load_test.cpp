#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "support/mesh_files.h"

namespace {

using namespace strata;
using test::count_of;
using test::load_text;

TEST(MeshLoad, equal_positions_are_welded_and_what_is_dropped_is_reported) {
  const auto loaded = load_text(
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv -0 0 0\nv 1 0 0\nv 1 1 0\nv 9 9 9\nv nan 0 0\nv 2 0 0\n"
      "f 1 2 3\nf 4 6 5\nf 3 2 1\nf 1 4 2\nf 1 2 9\n",
      "a.obj");
  ASSERT_TRUE(loaded) << loaded.error().detail;
  EXPECT_EQ(loaded->mesh.positions.size(), 4u);
  EXPECT_EQ(loaded->mesh.triangles, (std::vector<std::uint32_t>{0, 1, 2, 0, 3, 1}));
  EXPECT_EQ(count_of(loaded->repairs, "welded vertices at equal positions"), 2u);
  EXPECT_EQ(count_of(loaded->repairs, "dropped degenerate triangles"), 1u);
  EXPECT_EQ(count_of(loaded->repairs, "dropped triangles without area"), 1u);
  EXPECT_EQ(count_of(loaded->repairs, "dropped duplicate triangles"), 1u);
  EXPECT_EQ(count_of(loaded->repairs, "dropped unused vertices"), 2u);
  EXPECT_EQ(count_of(loaded->repairs,
                     "dropped unused vertices with coordinates that are no finite numbers"),
            1u);
}

TEST(MeshLoad, corner_coordinates_and_colours_follow_their_triangles_and_vertices) {
  const auto loaded = load_text(
      "v 5 5 5 0 0 0\nv 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\nvt 0 0\nvt .1 .2\nvt .3 .4\nvt .5 .6\n"
      "f 2/1 2/1 3/1\nf 2/2 3/3 4/4\n",
      "a.obj");
  ASSERT_TRUE(loaded);
  EXPECT_EQ(loaded->mesh.corner_uvs, (std::vector<glm::vec2>{{.1f, .2f}, {.3f, .4f}, {.5f, .6f}}));
  EXPECT_EQ(loaded->mesh.vertex_colors,
            (std::vector<std::uint32_t>{0xff0000ffu, 0xff00ff00u, 0xffff0000u}));
}

TEST(MeshLoad, unknown_formats_and_missing_files_are_refused) {
  EXPECT_EQ(load_text("x", "a.fbx").error().code, ErrorCode::unsupported);
  EXPECT_EQ(load_text("x", "ply").error().code, ErrorCode::invalid);
  Progress progress;
  EXPECT_EQ(mesh::load_mesh("/nonexistent/a.ply", "a.ply", progress).error().code,
            ErrorCode::invalid);
  EXPECT_EQ(mesh::load_mesh("/tmp", "a.ply", progress).error().code, ErrorCode::invalid);
}

TEST(MeshLoad, a_cancelled_load_stops) {
  Progress progress;
  progress.cancel();
  const std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  const auto loaded = mesh::load_mesh_bytes(
      {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, "a.obj", progress);
  ASSERT_FALSE(loaded);
  EXPECT_EQ(loaded.error().code, ErrorCode::cancelled);
}

TEST(MeshLoad, progress_ends_at_one) {
  Progress progress;
  const std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  ASSERT_TRUE(mesh::load_mesh_bytes(
      {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, "a.obj", progress));
  EXPECT_EQ(progress.fraction(), 1.0);
}

}  // namespace
