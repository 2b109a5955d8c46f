#include "query/maps/point_splats.h"
#include "mesh/surface/geometry.h"

#include <gtest/gtest.h>

#include <bit>

#include "mesh/atlas/atlas.h"
#include "mesh/texels/slot_bits.h"
#include "support/meshes.h"

namespace strata::query {
namespace {

struct Surface {
  mesh::Geometry geometry;
  mesh::SurfaceMap map;
  mesh::TexelGraph graph;
};

Surface surface_of(const mesh::TriangleMesh& mesh) {
  constexpr int kResolution = 512;
  Progress progress;
  Surface surface;
  surface.geometry = mesh::build_geometry(mesh, *mesh::make_atlas(mesh, kResolution, progress));
  surface.map = *mesh::bake_surface_map(surface.geometry, kResolution, progress);
  surface.graph = *mesh::build_texel_graph(surface.geometry, surface.map, progress);
  return surface;
}

// Returns a splat at the surface texel that is nearest to a point.
PointSplat splat_at(const mesh::SurfaceMap& map, const glm::vec3& point, std::uint32_t bits) {
  PointSplat splat;
  float least = 1e30f;
  for (std::uint32_t slot = 0; slot < map.block_of_slot.size(); ++slot)
    for (std::uint64_t left = map.surface_mask[slot]; left != 0; left &= left - 1) {
      const int i = std::countr_zero(left);
      const float distance = glm::distance(map.position(slot, i), point);
      if (distance >= least) continue;
      least = distance;
      splat = {slot * 64 + static_cast<std::uint32_t>(i), map.position(slot, i), bits};
    }
  return splat;
}

struct Texel {
  glm::vec3 position;
  bool surface;
  std::optional<std::uint32_t> bits;  // set for painted texels
};

// Returns all surface and gutter texels with the value that the result paints there.
std::vector<Texel> texels_of(const mesh::SurfaceMap& map,
                             const std::map<TileAddress, TileData>& painted) {
  std::vector<Texel> texels;
  for (int y = 0; y < map.resolution; ++y)
    for (int x = 0; x < map.resolution; ++x) {
      const TileAddress tile{static_cast<std::uint16_t>(x / kTileSize),
                             static_cast<std::uint16_t>(y / kTileSize)};
      const int in_tile = y % kTileSize * kTileSize + x % kTileSize;
      const auto [slot, i] = mesh::slot_texel(map, tile, in_tile);
      const auto found = painted.find(tile);
      const bool is = found != painted.end() && found->second.valid.test(in_tile);
      if (slot == mesh::kNoSlot ||
          map.packed_position[std::size_t{slot} * 64 + i] == mesh::kNoPosition) {
        EXPECT_FALSE(is) << "beside the surface";
        continue;
      }
      texels.push_back({map.position(slot, i), ((map.surface_mask[slot] >> i) & 1u) != 0,
                        is ? std::optional(found->second.bits(in_tile)) : std::nullopt});
    }
  return texels;
}

TEST(PointSplats, cover_what_lies_within_the_radius_and_the_nearest_one_counts) {
  const Surface sphere = surface_of(test::sphere(48));
  const std::vector<PointSplat> point_splats{splat_at(sphere.map, {0, 0, 1}, 5),
                                             splat_at(sphere.map, {0.3, 0, 1}, 6),
                                             splat_at(sphere.map, {-1, 0, 0}, 7)};
  const float radius = 0.35f;
  const auto painted =
      paint_point_splats(sphere.map, sphere.graph, point_splats, radius, ValueType::u16);
  ASSERT_TRUE(painted);
  int wrong = 0, gutter = 0;
  std::map<std::uint32_t, int> count;
  for (const Texel& texel : texels_of(sphere.map, *painted)) {
    const PointSplat* nearest = nullptr;
    for (const PointSplat& splat : point_splats)
      if (!nearest || glm::distance(texel.position, splat.position) <
                          glm::distance(texel.position, nearest->position))
        nearest = &splat;
    const bool inside = glm::distance(texel.position, nearest->position) <= radius;
    wrong += texel.bits != (inside ? std::optional(nearest->bits) : std::nullopt);
    if (texel.bits) ++count[*texel.bits];
    gutter += texel.bits && !texel.surface;
  }
  EXPECT_LE(wrong, 3) << "a texel may hang on a dab's border by a corner";
  EXPECT_GT(gutter, 10);
  for (const std::uint32_t bits : {5u, 6u, 7u}) EXPECT_GT(count[bits], 500) << bits;
}

TEST(PointSplats, do_not_reach_through_a_wall) {
  mesh::TriangleMesh walls = test::open_grid(20, 0.0);
  walls.corner_uvs.clear();
  const mesh::TriangleMesh other = test::transformed(walls, 1, {0, 0, 0.02});
  const auto first = static_cast<std::uint32_t>(walls.positions.size());
  walls.positions.insert(walls.positions.end(), other.positions.begin(), other.positions.end());
  for (const std::uint32_t corner : other.triangles) walls.triangles.push_back(first + corner);
  const Surface surface = surface_of(walls);
  const glm::vec3 middle = (surface.geometry.box_min + surface.geometry.box_max) * 0.5f;
  const PointSplat splat =
      splat_at(surface.map, {middle.x, middle.y, surface.geometry.box_max.z}, 1);
  const auto painted =
      paint_point_splats(surface.map, surface.graph, std::span(&splat, 1), 0.2f, ValueType::u8);
  ASSERT_TRUE(painted);
  int near = 0, behind = 0;
  for (const Texel& texel : texels_of(surface.map, *painted))
    if (texel.bits) ++(texel.position.z > middle.z ? near : behind);
  EXPECT_GT(near, 200);
  EXPECT_EQ(behind, 0);
}

TEST(PointSplats, smaller_than_a_texel_are_not_lost) {
  const Surface sphere = surface_of(test::sphere(24));
  const PointSplat splat = splat_at(sphere.map, {0, 1, 0}, 3);
  const auto painted =
      paint_point_splats(sphere.map, sphere.graph, std::span(&splat, 1), 1e-6f, ValueType::u8);
  ASSERT_TRUE(painted);
  int surface = 0;
  for (const Texel& texel : texels_of(sphere.map, *painted))
    surface += texel.surface && texel.bits == 3u;
  EXPECT_EQ(surface, 1);
}

TEST(PointSplats, that_would_take_for_ever_are_refused) {
  const Surface sphere = surface_of(test::sphere(24));
  const std::vector<PointSplat> point_splats(10'000, splat_at(sphere.map, {0, 1, 0}, 3));
  const auto painted =
      paint_point_splats(sphere.map, sphere.graph, point_splats, 10, ValueType::u8);
  ASSERT_FALSE(painted);
  EXPECT_EQ(painted.error().code, ErrorCode::invalid);
}

}  // namespace
}  // namespace strata::query
