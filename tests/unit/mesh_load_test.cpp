#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

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
  EXPECT_EQ(count_of(loaded->repairs, "dropped unused vertices"), 3u);
}

TEST(MeshLoad, corner_coordinates_and_colours_follow_their_triangles_and_vertices) {
  const auto loaded = load_text(
      "v 5 5 5 0 0 0\nv 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\nvt 0 0\nvt .1 .2\nvt .3 .4\nvt .5 .6\n"
      "f 2/1 2/1 3/1\nf 2/2 3/3 4/4\n",
      "a.obj");
  ASSERT_TRUE(loaded);
  EXPECT_EQ(loaded->mesh.corner_uvs, (std::vector<glm::vec2>{{.1f, .2f}, {.3f, .4f}, {.5f, .6f}}));
  EXPECT_EQ(loaded->mesh.vertex_colors, (std::vector<std::uint32_t>{0xff0000ffu, 0xff00ff00u, 0xffff0000u}));
}

TEST(MeshLoad, unknown_formats_and_missing_files_are_refused) {
  EXPECT_EQ(load_text("x", "a.stl").error().status, 415);
  EXPECT_EQ(load_text("x", "ply").error().status, 422);
  Progress progress;
  EXPECT_EQ(mesh::load_mesh("/nonexistent/a.ply", "a.ply", progress).error().status, 422);
  EXPECT_EQ(mesh::load_mesh("/tmp", "a.ply", progress).error().status, 422);
}

TEST(MeshLoad, a_cancelled_load_stops) {
  Progress progress;
  progress.cancel();
  const std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  const auto loaded =
      mesh::load_mesh_bytes({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, "a.obj", progress);
  ASSERT_FALSE(loaded);
  EXPECT_EQ(loaded.error().status, 499);
}

TEST(MeshLoad, progress_ends_at_one) {
  Progress progress;
  const std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  ASSERT_TRUE(
      mesh::load_mesh_bytes({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, "a.obj", progress));
  EXPECT_EQ(progress.fraction(), 1.0);
}

// The scans beside the source tree, against figures measured by a reader that shares no code with this one.
class MeshScans : public testing::Test {
 protected:
  void SetUp() override {
    std::ifstream facts(std::string(STRATA_TEST_DATA) + "/FACTS.json");
    if (!facts) GTEST_SKIP() << "NO SCANS in " << STRATA_TEST_DATA << ": nothing of real files is tested";
    std::string text{std::istreambuf_iterator<char>(facts), {}};
    for (std::size_t at; (at = text.find(": NaN")) != text.npos;) text.replace(at, 5, ": null");  // the area of n05
    facts_ = nlohmann::json::parse(text);
  }
  static Result<mesh::LoadedMesh> load(const std::string& name) {
    Progress progress;
    return mesh::load_mesh(std::string(STRATA_TEST_DATA) + "/" + name, name, progress);
  }
  nlohmann::json facts_;
};

TEST_F(MeshScans, good_files_have_the_measured_triangles_positions_and_area) {
  for (const auto& [name, fact] : facts_.items()) {
    const bool readable = name.ends_with(".ply") || name.ends_with(".obj");
    if (!readable || !fact.contains("distinct_positions") || fact.value("faces_index_out_of_range", 0) > 0 ||
        name.find("n05") != name.npos || name.find("n20") != name.npos) {
      continue;
    }
    SCOPED_TRACE(name);
    const auto loaded = load(name);
    ASSERT_TRUE(loaded) << loaded.error().detail;
    const auto& welded = fact["after_exact_weld"].is_null() ? fact["as_indexed"] : fact["after_exact_weld"];
    const std::uint64_t degenerate = welded.value("index_degenerate_faces", 0),
                        duplicate = welded.value("duplicate_faces", 0);
    EXPECT_EQ(count_of(loaded->repairs, "dropped degenerate triangles"), degenerate);
    EXPECT_EQ(count_of(loaded->repairs, "dropped duplicate triangles"), duplicate);
    const std::uint64_t flat = count_of(loaded->repairs, "dropped triangles without area");
    EXPECT_EQ(loaded->mesh.triangle_count(), fact["triangles"].get<std::uint64_t>() - degenerate - duplicate - flat);
    EXPECT_EQ(count_of(loaded->repairs, "welded vertices at equal positions"),
              fact.value("duplicate_position_vertices", 0u));
    EXPECT_EQ(loaded->mesh.positions.size() + count_of(loaded->repairs, "dropped unused vertices"),
              fact["distinct_positions"].get<std::uint64_t>());
    // Duplicates count twice there, and a fan over the concave pentagon of n09 folds over itself.
    if (duplicate == 0 && name.find("n09") == name.npos) {
      const double area = fact["surface_area"];
      EXPECT_NEAR(mesh::surface_area(loaded->mesh), area, area * 1e-9);
    }
  }
}

TEST_F(MeshScans, bad_files_are_refused) {
  const std::pair<const char*, const char*> bad[] = {{"nasty/n05_nan_inf_vertices.ply", "2 vertices"},
                                                     {"nasty/n18_bad_truncated.ply", "cut short"},
                                                     {"nasty/n19_bad_header_lies.ply", "4000000000"},
                                                     {"nasty/n20_bad_index.obj", "Line 12"},
                                                     {"nasty/n21_empty.ply", "no triangle"},
                                                     {"nasty/n22_points_only.ply", "2880 vertices but no triangle"},
                                                     {"nasty/n23_bad_index.ply", "Face 5"}};
  for (const auto& [name, says] : bad) {
    const auto loaded = load(name);
    ASSERT_FALSE(loaded) << name;
    EXPECT_THAT(loaded.error().detail, testing::HasSubstr(says));
  }
}

TEST_F(MeshScans, a_concave_polygon_of_a_real_file_has_its_true_area) {
  const auto quads = load("nasty/n06_uv_mirrored_overlap.obj"),
             polygons = load("nasty/n09_quads_ngons_negative_crlf.obj");
  ASSERT_TRUE(quads && polygons);
  EXPECT_EQ(polygons->mesh.triangle_count(), quads->mesh.triangle_count() + 5);
  EXPECT_EQ(count_of(polygons->repairs, "triangles without texture coordinates"), 5u);
}

TEST_F(MeshScans, utm_coordinates_stay_exact_to_the_micrometre) {
  const auto loaded = load("nasty/n10a_utm_double.ply");
  ASSERT_TRUE(loaded);
  EXPECT_NEAR(mesh::surface_area(loaded->mesh), 0.0498561851, 1e-9);
  EXPECT_GT(loaded->mesh.positions[0].y, 4581234.0);
}

}  // namespace
