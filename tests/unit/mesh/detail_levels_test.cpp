#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <tuple>

#include "mesh/atlas/atlas.h"
#include "mesh/surface/detail_levels.h"
#include "mesh/surface/search_tree.h"
#include "support/meshes.h"

namespace strata {
namespace {

mesh::Geometry unwrapped(const mesh::TriangleMesh& mesh) {
  Progress progress;
  auto atlas = mesh::make_atlas(mesh, 2048, progress);
  return mesh::build_geometry(mesh, atlas.value());
}

class DetailLevels : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    full_ = std::make_shared<const mesh::Geometry>(unwrapped(test::torus(480)));
    Progress progress;
    levels_ = mesh::make_detail_levels(*full_, progress).value();
  }
  static void TearDownTestSuite() { full_.reset(); }
  inline static std::shared_ptr<const mesh::Geometry> full_;
  inline static std::vector<mesh::Geometry> levels_;
};

TEST_F(DetailLevels, have_a_quarter_of_the_triangles_each_down_to_the_coarsest) {
  ASSERT_GE(full_->triangle_count(), 2 * mesh::kCoarsestLevelTriangles)
      << "the test needs a larger mesh";
  ASSERT_FALSE(levels_.empty());
  std::size_t finer = full_->triangle_count();
  for (const auto& level : levels_) {
    EXPECT_LE(level.triangle_count(), finer * 7 / 10);
    finer = level.triangle_count();
  }
  EXPECT_NEAR(static_cast<double>(finer), mesh::kCoarsestLevelTriangles,
              0.05 * mesh::kCoarsestLevelTriangles);
}

TEST_F(DetailLevels, have_no_vertex_that_the_model_has_not) {
  using Key = std::tuple<float, float, float, float, float, std::uint32_t>;
  const auto key = [](const mesh::Vertex& v) {
    return Key{v.position.x, v.position.y, v.position.z, v.uv.x, v.uv.y, v.normal};
  };
  std::map<Key, int> known;
  for (const auto& vertex : full_->vertices) ++known[key(vertex)];
  for (const auto& level : levels_) {
    EXPECT_EQ(level.origin, full_->origin);
    for (const auto& vertex : level.vertices) {
      ASSERT_TRUE(known.contains(key(vertex)));
      const auto in_model = glm::vec3(level.positions.at(vertex.position_index) - level.origin);
      ASSERT_EQ(in_model, vertex.position);
    }
  }
}

TEST_F(DetailLevels, lie_near_the_surface_and_show_nearly_the_texels_that_lie_there) {
  const mesh::SearchTree tree(full_);
  const float extent = glm::distance(full_->box_min, full_->box_max);
  for (const auto& level : levels_) {
    double shift_sum = 0;
    std::size_t compared = 0;
    for (std::size_t i = 0; i + 2 < level.indices.size(); i += 3 * 7) {
      const auto& a = level.vertices[level.indices[i]];
      const auto& b = level.vertices[level.indices[i + 1]];
      const auto& c = level.vertices[level.indices[i + 2]];
      const auto hit = tree.nearest((a.position + b.position + c.position) / 3.0f, extent);
      ASSERT_TRUE(hit);
      ASSERT_LT(hit->distance, 0.002f * extent);
      shift_sum += glm::distance((a.uv + b.uv + c.uv) / 3.0f, hit->uv);
      ++compared;
    }
    // The limit is half a texel of a 2048² layer.
    EXPECT_LT(shift_sum / static_cast<double>(compared), 0.5 / 2048);
  }
}

TEST_F(DetailLevels, survive_being_stored) {
  for (const auto& level : levels_) {
    const auto read = mesh::decode_geometry(mesh::encode_geometry(level));
    ASSERT_TRUE(read);
    EXPECT_EQ(read->indices, level.indices);
    EXPECT_EQ(read->clusters.size(), level.clusters.size());
    EXPECT_EQ(read->box_min, level.box_min);
  }
}

TEST(DetailLevelsOfSmallModels, are_none) {
  Progress progress;
  EXPECT_TRUE(mesh::make_detail_levels(unwrapped(test::sphere(100)), progress).value().empty());
}

TEST(DetailLevelsOfSoup, are_none_since_nothing_can_be_collapsed) {
  const auto soup = test::separate_triangles(210'000);
  mesh::Atlas atlas;
  Progress progress;
  EXPECT_TRUE(
      mesh::make_detail_levels(mesh::build_geometry(soup, atlas), progress).value().empty());
}

TEST(DetailLevelsThatAreCancelled, are_refused) {
  const auto geometry = mesh::build_geometry(test::torus(480), {});
  Progress progress;
  progress.cancel();
  const auto levels = mesh::make_detail_levels(geometry, progress);
  ASSERT_FALSE(levels);
  EXPECT_EQ(levels.error().code, ErrorCode::cancelled);
}

TEST(ClusterBoxes, hold_their_triangles_and_make_up_the_box) {
  const auto geometry = mesh::build_geometry(test::torus(60), {});
  constexpr std::size_t kTriangles = mesh::Geometry::kTrianglesPerCluster;
  ASSERT_EQ(geometry.clusters.size(), (geometry.triangle_count() + kTriangles - 1) / kTriangles);
  for (std::size_t i = 0; i < geometry.indices.size(); ++i) {
    const auto& box = geometry.clusters[i / (3 * kTriangles)];
    const auto& p = geometry.vertices[geometry.indices[i]].position;
    ASSERT_TRUE(glm::all(glm::lessThanEqual(box.min, p)) &&
                glm::all(glm::lessThanEqual(p, box.max)));
  }
}

}  // namespace
}  // namespace strata
