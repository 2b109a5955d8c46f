#include "query/sampling/baked_colors.h"

#include <gtest/gtest.h>

#include <cmath>

#include "mesh/texels/texel_owners.h"
#include "support/meshes.h"

namespace strata::query {
namespace {

constexpr int kSize = 512;

std::shared_ptr<mesh::Geometry> geometry_of(const mesh::TriangleMesh& mesh) {
  Progress progress;
  auto atlas = mesh::make_atlas(mesh, kSize, progress);
  EXPECT_TRUE(atlas);
  return std::make_shared<mesh::Geometry>(mesh::build_geometry(mesh, *atlas));
}

const std::uint8_t* pixel(const Picture& picture, int x, int y) {
  return &picture.rgba[(static_cast<std::size_t>(y) * kSize + static_cast<std::size_t>(x)) * 4];
}

TEST(BakedColors, a_pixel_has_the_color_of_the_surface_at_its_center) {
  for (const auto& [name, mesh] : test::mesh_classes()) {
    const auto geometry = geometry_of(mesh);
    for (std::size_t i = 0; i < geometry->vertices.size(); ++i)
      geometry->vertices[i].color = static_cast<std::uint32_t>(i * 2654435761u) | 0xff000000u;
    Picture photo{2, 2, {250, 0, 0, 255, 0, 250, 0, 255, 0, 0, 250, 128, 9, 9, 9, 0}};
    SurfaceColors colors(geometry);
    colors.add_photo(photo, 0.5);
    Progress progress;
    const auto baked = bake_colors(*geometry, colors, kSize, progress);
    ASSERT_TRUE(baked) << name;
    const auto owners = mesh::bake_texel_owners(*geometry, kSize, progress);
    ASSERT_TRUE(owners);
    std::size_t compared = 0;
    for (std::size_t slot = 0; slot < owners->block_of_slot.size(); ++slot)
      for (int texel = 0; texel < 64; ++texel) {
        if (!(owners->surface_mask[slot] >> texel & 1)) continue;
        const auto block = static_cast<int>(owners->block_of_slot[slot]);
        const int x = block % owners->blocks_per_side * 8 + texel % 8,
                  y = block / owners->blocks_per_side * 8 + texel / 8;
        mesh::SearchTree::Hit point{};
        point.triangle = owners->triangle[slot * 64 + static_cast<std::size_t>(texel)];
        point.barycentric = owners->weights_of(slot * 64 + static_cast<std::size_t>(texel));
        point.uv = (glm::vec2(x, y) + 0.5f) / static_cast<float>(kSize);
        const glm::dvec3 expected = colors.at(point);
        const std::uint8_t* rgba = pixel(*baked, x, kSize - 1 - y);
        for (int channel = 0; channel < 3; ++channel)
          ASSERT_NEAR(rgba[channel], expected[channel], 0.51) << name;
        ++compared;
      }
    EXPECT_GT(compared, 1000u) << name;
  }
}

TEST(BakedColors, pixels_between_the_charts_continue_the_colors) {
  for (const auto& [name, mesh] : test::mesh_classes()) {
    const auto geometry = geometry_of(mesh);
    for (mesh::Vertex& vertex : geometry->vertices) vertex.color = 0xff204060u;
    Progress progress;
    const auto baked = bake_colors(*geometry, SurfaceColors(geometry), kSize, progress);
    ASSERT_TRUE(baked) << name;
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x) {
        const std::uint8_t* rgba = pixel(*baked, x, y);
        ASSERT_EQ((std::array<int, 4>{rgba[0], rgba[1], rgba[2], rgba[3]}),
                  (std::array<int, 4>{0x60, 0x40, 0x20, 255}))
            << name << " at " << x << ", " << y;
      }
  }
}

TEST(BakedColors, baking_ends_when_it_is_cancelled) {
  const auto geometry = geometry_of(test::mesh_classes().front().mesh);
  Progress progress;
  progress.cancel();
  const auto baked = bake_colors(*geometry, SurfaceColors(geometry), kSize, progress);
  ASSERT_FALSE(baked);
  EXPECT_EQ(baked.error().code, ErrorCode::cancelled);
  EXPECT_GT(bytes_to_bake(*geometry, 1024), 1024u * 1024 * 12);
}

}  // namespace
}  // namespace strata::query
