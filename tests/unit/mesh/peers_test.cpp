// Files from the test suites of other projects, which are next to the source tree. Each of these
// files made some reader fail. Each test has the expected result.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "mesh/io/load.h"
#include "strata_dirs.h"

namespace {

using namespace strata;
using testing::HasSubstr;
namespace fs = std::filesystem;

const fs::path kPeers = fs::path(STRATA_TEST_DATA) / "peers";

class MeshPeers : public testing::Test {
 protected:
  void SetUp() override {
    if (!fs::exists(kPeers))
      GTEST_SKIP() << "NO FILES OF OTHER PROJECTS in " << kPeers << ": nothing of them is tested";
  }
  static Result<mesh::LoadedMesh> load(const std::vector<std::string>& names) {
    std::vector<mesh::InputFile> files;
    for (const std::string& name : names) files.push_back({name, kPeers / name});
    Progress progress;
    return mesh::load_mesh(files, progress);
  }
  static std::uint64_t count_of(const mesh::LoadedMesh& loaded, const std::string& what) {
    for (const Repair& repair : loaded.repairs)
      if (repair.what.starts_with(what)) return repair.count;
    return 0;
  }
};

TEST_F(MeshPeers, normalised_shorts_of_draco_have_the_size_that_their_accessor_says) {
  const auto sphere = load({"DenseSphere.glb"});
  ASSERT_TRUE(sphere) << sphere.error().detail;
  EXPECT_NEAR(mesh::surface_area(sphere->mesh), 10.7855, 0.00005);
  double radius = 0;
  for (const auto& p : sphere->mesh.positions) radius = std::max(radius, glm::length(p));
  EXPECT_NEAR(radius, 0.93, 0.005);
}

TEST_F(MeshPeers, draco_gives_the_texture_coordinates_and_colours_of_the_plain_file) {
  const auto plain = load({"d01_uv_u16norm_plain.glb"}), draco = load({"d02_uv_u16norm_draco.glb"});
  ASSERT_TRUE(plain && draco);
  ASSERT_EQ(draco->mesh.textures.size(), 1u);
  EXPECT_EQ(draco->mesh.textures[0].bytes, plain->mesh.textures[0].bytes);
  const auto extent = [](const mesh::TriangleMesh& mesh) {
    glm::vec2 least(1e9f), most(-1e9f);
    for (const auto& uv : mesh.corner_uvs) {
      least = glm::min(least, uv);
      most = glm::max(most, uv);
    }
    return std::pair(least, most);
  };
  const auto [least, most] = extent(draco->mesh);
  const auto [plain_least, plain_most] = extent(plain->mesh);
  EXPECT_LT(glm::length(least - plain_least) + glm::length(most - plain_most), 1e-3f);

  const auto tinted = load({"d03_col_u8_draco.glb"}), as_plain = load({"d03_col_u8_plain.glb"});
  ASSERT_TRUE(tinted && as_plain);
  const auto mean = [](const mesh::TriangleMesh& mesh) {
    glm::dvec3 sum(0);
    for (const auto color : mesh.vertex_colors)
      sum += glm::dvec3(color & 255, color >> 8 & 255, color >> 16 & 255) /
             double(mesh.vertex_colors.size());
    return sum;
  };
  EXPECT_LT(glm::length(mean(tinted->mesh) - mean(as_plain->mesh)), 0.5);
  EXPECT_LT(mean(tinted->mesh).x, 250) << "not white";
}

TEST_F(MeshPeers, text_stl_of_every_habit_is_read) {
  const std::pair<std::string, std::size_t> files[] = {{"block.stl", 12},
                                                       {"HalfDonut.stl", 288},
                                                       {"20mmbox-CR.stl", 12},
                                                       {"single_triangle_with_comments.stl", 1},
                                                       {"gearwheel.ascii.stl", 2444}};
  for (const auto& [name, triangles] : files) {
    const auto loaded = load({name});
    ASSERT_TRUE(loaded) << name << loaded.error().detail;
    EXPECT_EQ(loaded->mesh.triangle_count() + count_of(*loaded, "dropped degenerate") +
                  count_of(*loaded, "dropped triangles") + count_of(*loaded, "dropped duplicate") +
                  count_of(*loaded, "dropped slivers"),
              triangles)
        << name;
  }
  EXPECT_NEAR(mesh::surface_area(load({"20mmbox-CR.stl"})->mesh), 6 * 20 * 20, 1e-3);
}

TEST_F(MeshPeers, surplus_words_of_a_ply_are_said) {
  const auto loaded = load({"fuze_ascii.ply"});
  ASSERT_TRUE(loaded) << loaded.error().detail;
  EXPECT_EQ(loaded->mesh.triangle_count(), 1000u);
  EXPECT_FALSE(loaded->mesh.corner_uvs.empty());
  EXPECT_EQ(count_of(*loaded, "lines with more values than declared"), 1000u);
}

TEST_F(MeshPeers, faces_of_an_obj_that_name_absent_coordinates_are_said) {
  for (const std::string name :
       {"box-missing-attributes.obj", "box-incomplete-uvs.obj", "cubevt.obj"}) {
    const auto loaded = load({name});
    ASSERT_TRUE(loaded) << name << loaded.error().detail;
    EXPECT_EQ(loaded->mesh.triangle_count(), 12u) << name;
    EXPECT_GT(count_of(*loaded, "faces that refer to texture coordinates missing from the file") +
                  count_of(*loaded, "faces that refer to normals missing from the file"),
              0u)
        << name;
  }
}

TEST_F(MeshPeers, khr_meshopt_needs_no_fallback) {
  const auto loaded = load({"meshopt-no-fallback.gltf", "meshopt-no-fallback.bin"});
  ASSERT_TRUE(loaded) << loaded.error().detail;
  EXPECT_EQ(loaded->mesh.triangle_count(), 60u);
  EXPECT_NEAR(mesh::surface_area(loaded->mesh), 32.1248186, 1e-5) << "as another decoder has it";
}

// Its textures have no image, which is not an error. But the file has no positions and no scene
// either.
TEST_F(MeshPeers, a_file_without_any_positions_is_refused_for_that_and_not_for_its_textures) {
  const auto loaded = load({"texcoord-flip.gltf", "texcoord-flip.bin"});
  ASSERT_FALSE(loaded);
  EXPECT_THAT(loaded.error().detail, HasSubstr("no node of its scene uses one"));
}

}  // namespace
