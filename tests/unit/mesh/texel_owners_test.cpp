#include <gtest/gtest.h>

#include <bit>

#include "mesh/atlas/atlas.h"
#include "mesh/texels/surface_map.h"
#include "mesh/texels/texel_owners.h"
#include "support/meshes.h"

namespace strata::mesh {
namespace {

constexpr int kResolution = 512;

struct Painted {
  std::string name;
  std::shared_ptr<const Geometry> geometry;
  SurfaceMap map;
  TexelOwners owners;
};

std::vector<Painted> all_classes() {
  std::vector<Painted> all;
  for (auto& [name, mesh] : test::mesh_classes()) {
    Progress progress;
    auto atlas = make_atlas(mesh, kResolution, progress);
    EXPECT_TRUE(atlas) << name;
    if (!atlas) continue;
    auto geometry = std::make_shared<const Geometry>(build_geometry(mesh, *atlas));
    auto map = bake_surface_map(*geometry, kResolution, progress);
    auto owners = bake_texel_owners(*geometry, kResolution, progress);
    EXPECT_TRUE(map && owners) << name;
    if (map && owners)
      all.push_back({name, std::move(geometry), std::move(*map), std::move(*owners)});
  }
  return all;
}

glm::vec3 point_of(const Geometry& geometry, std::uint32_t triangle, const glm::vec3& weights) {
  glm::vec3 point(0);
  for (int k = 0; k < 3; ++k)
    point +=
        weights[k] * geometry.vertices[geometry.indices[3 * std::size_t{triangle} + k]].position;
  return point;
}

TEST(TexelOwners, are_those_texels_and_places_that_the_surface_map_has) {
  for (const auto& [name, geometry, map, owners] : all_classes()) {
    ASSERT_EQ(owners.block_of_slot, map.block_of_slot) << name;
    ASSERT_EQ(owners.surface_mask, map.surface_mask) << name;
    EXPECT_EQ(owners.gutter.size(), map.gutter_texels) << name;
    const float diagonal = glm::length(geometry->box_max - geometry->box_min);
    for (std::uint32_t slot = 0; slot < map.block_of_slot.size(); ++slot)
      for (std::uint64_t left = map.surface_mask[slot]; left; left &= left - 1) {
        const int i = std::countr_zero(left);
        const std::size_t texel = std::size_t{slot} * 64 + i;
        ASSERT_LT(owners.triangle[texel], geometry->triangle_count()) << name;
        const glm::vec3 there =
            point_of(*geometry, owners.triangle[texel], owners.weights_of(texel));
        ASSERT_LT(glm::distance(there, map.position(slot, i)), 5e-5f * diagonal) << name;
      }
  }
}

TEST(TexelOwners, paint_every_surface_texel_once_and_the_gutter_like_its_owner) {
  for (const auto& [name, geometry, map, owners] : all_classes()) {
    Progress progress;
    const auto tiles = paint_texels(
        owners, ValueType::f32,
        [&g = *geometry, &o = owners](std::size_t texel) -> std::optional<std::uint32_t> {
          const glm::vec3 p = point_of(g, o.triangle[texel], o.weights_of(texel));
          if (p.x > 0.2f) return std::nullopt;
          return std::bit_cast<std::uint32_t>(p.y);
        },
        progress);
    ASSERT_TRUE(tiles) << name;
    std::uint64_t painted = 0, expected = 0;
    for (const auto& [address, tile] : *tiles) painted += tile->valid.count();
    const auto value_of = [&, &the_tiles = *tiles,
                           &the_map = map](std::size_t texel) -> std::optional<float> {
      const auto block = the_map.block_of_slot[texel / 64];
      const int x = int(block % the_map.blocks_per_side) * 8 + int(texel % 8),
                y = int(block / the_map.blocks_per_side) * 8 + int(texel % 64 / 8);
      const auto tile =
          the_tiles.find({std::uint16_t(x / kTileSize), std::uint16_t(y / kTileSize)});
      const int in_tile = y % kTileSize * kTileSize + x % kTileSize;
      if (tile == the_tiles.end() || !tile->second->valid.test(in_tile)) return std::nullopt;
      return std::bit_cast<float>(tile->second->bits(in_tile));
    };
    for (std::uint32_t slot = 0; slot < map.block_of_slot.size(); ++slot)
      for (std::uint64_t left = map.surface_mask[slot]; left; left &= left - 1) {
        const std::size_t texel = std::size_t{slot} * 64 + std::countr_zero(left);
        const glm::vec3 p = point_of(*geometry, owners.triangle[texel], owners.weights_of(texel));
        const auto value = value_of(texel);
        ASSERT_EQ(value.has_value(), p.x <= 0.2f) << name;
        if (value) {
          ASSERT_EQ(*value, p.y) << name;
        }
        expected += value.has_value();
      }
    for (const auto& [texel, owner] : owners.gutter) {
      ASSERT_EQ(value_of(texel), value_of(owner)) << name;
      expected += value_of(owner).has_value();
    }
    EXPECT_EQ(painted, expected) << name;
  }
}

TEST(TexelOwners, do_not_depend_on_the_number_of_threads) {
  const auto mesh = test::sphere(40);
  Progress progress;
  const auto atlas = make_atlas(mesh, kResolution, progress);
  ASSERT_TRUE(atlas);
  const Geometry geometry = build_geometry(mesh, *atlas);
  const auto one = bake_texel_owners(geometry, kResolution, progress, 1),
             three = bake_texel_owners(geometry, kResolution, progress, 3);
  ASSERT_TRUE(one && three);
  EXPECT_EQ(one->triangle, three->triangle);
  EXPECT_EQ(one->weights, three->weights);
}

TEST(TexelOwners, can_be_cancelled_and_refuse_an_impossible_resolution) {
  const Geometry geometry = build_geometry(test::sphere(12), Atlas{});
  Progress progress;
  EXPECT_EQ(bake_texel_owners(geometry, 100, progress).error().code, ErrorCode::malformed);
  progress.cancel();
  EXPECT_EQ(bake_texel_owners(geometry, kResolution, progress).error().code, ErrorCode::cancelled);
  TexelOwners owners;
  const auto nothing = [](std::size_t) { return std::optional<std::uint32_t>(); };
  EXPECT_EQ(paint_texels(owners, ValueType::f32, nothing, progress).error().code,
            ErrorCode::cancelled);
}

}  // namespace
}  // namespace strata::mesh
