// The colors and normals of texels that a room keeps: their memory, their sources and their end.
#include "room/caches/appearance_cache.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "support/meshes.h"
#include "support/surfaces.h"

namespace strata::room {
namespace {

constexpr int kResolution = 256;

// A grid whose vertices are red on one half and green on the other.
class AppearanceCacheTest : public ::testing::Test {
 protected:
  AppearanceCacheTest() {
    mesh::TriangleMesh mesh = test::open_grid(8);
    for (const glm::dvec3& at : mesh.positions)
      mesh.vertex_colors.push_back(at.x < 0.5 ? 0xff0000ffu : 0xff00ff00u);
    surface_ = test::surface_of("grid", mesh, kResolution);
    geometry_ = std::make_shared<const mesh::Geometry>(surface_.geometry);
    texels_ = surface_.map.block_of_slot.size() * 64;
  }

  Result<AppearanceCache::Texels> normals(AppearanceCache& cache) {
    return cache.normals(surface_.map);
  }

  // Returns an image of one color, which covers the whole atlas.
  static SurfaceImage image(const std::string& sha256, double opacity) {
    SurfaceImage image;
    image.sha256 = sha256;
    image.media_type = "image/jpeg";
    image.opacity = opacity;
    return image;
  }
  // Returns the red of a texel on the red half of the grid, which the images in blue cover.
  std::uint32_t red_under(AppearanceCache& cache, std::vector<SurfaceImage> images) {
    drawn_ = 0;
    const auto read = [&](const SurfaceImage&, int) -> Result<HeldPicture> {
      ++drawn_;
      return HeldPicture{{1, 1, {0, 0, 255, 255}}, {}};
    };
    const auto colors = cache.colors(surface_.map, {true, std::move(images)}, read);
    EXPECT_TRUE(colors);
    std::uint32_t red = 0;
    test::for_each_surface_texel(
        surface_.map, [&](std::uint32_t texel) { red = std::max(red, (**colors)[texel] & 0xffu); });
    return red;
  }

  int drawn_ = 0;  // images that the last call of `red_under` read
  test::Surface surface_;
  std::shared_ptr<const mesh::Geometry> geometry_;
  std::uint64_t texels_ = 0;
};

TEST_F(AppearanceCacheTest, the_memory_of_the_work_is_reserved_and_only_the_result_stays) {
  MemoryLedger little("memory", "--memory", texels_ * 12 - 1);
  AppearanceCache refused(geometry_, little);
  const auto none = normals(refused);
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, ErrorCode::out_of_memory);
  EXPECT_EQ(little.used(), 0u);

  MemoryLedger enough("memory", "--memory", texels_ * 12);
  AppearanceCache cache(geometry_, enough);
  ASSERT_TRUE(normals(cache));
  EXPECT_EQ(enough.used(), texels_ * 4);
  EXPECT_TRUE(cache.drop());
  EXPECT_EQ(enough.used(), 0u);
}

TEST_F(AppearanceCacheTest, only_an_image_with_full_opacity_covers_the_colors_below_it) {
  MemoryLedger memory("memory", "--memory", std::uint64_t{1} << 40);
  AppearanceCache cache(geometry_, memory);
  EXPECT_EQ(red_under(cache, {}), 255u);
  EXPECT_EQ(red_under(cache, {image("a", 0.5), image("b", 1)}), 0u);
  EXPECT_EQ(drawn_, 1) << "the upper image covers the lower one";
  EXPECT_NEAR(red_under(cache, {image("b", 1), image("a", 0.5)}), 0, 1);
  EXPECT_EQ(drawn_, 2);
  EXPECT_NEAR(red_under(cache, {image("a", 0.5)}), 128, 1);
  EXPECT_NEAR(red_under(cache, {image("a", 0.2)}), 204, 1) << "the opacity has changed";
  EXPECT_EQ(drawn_, 1);
  EXPECT_NEAR(red_under(cache, {image("a", 0.2)}), 204, 1);
  EXPECT_EQ(drawn_, 0) << "the colors are kept";
}

TEST_F(AppearanceCacheTest, nothing_is_made_after_the_end) {
  MemoryLedger memory("memory", "--memory", std::uint64_t{1} << 40);
  AppearanceCache cache(geometry_, memory);
  cache.stop();
  const auto stopped = normals(cache);
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().code, ErrorCode::cancelled);
  EXPECT_EQ(memory.used(), 0u);
}

}  // namespace
}  // namespace strata::room
