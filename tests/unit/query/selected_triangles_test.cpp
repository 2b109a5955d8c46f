#include "query/regions/selected_triangles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <set>

#include "mesh/texels/surface_map.h"
#include "mesh/texels/texel_owners.h"
#include "support/meshes.h"
#include "support/scene_models.h"

namespace strata::query {
namespace {

constexpr int kResolution = 128;
constexpr float kTexel = 1.0f / kResolution;

// A grid in one chart whose texture coordinates are 0.05 + 0.9 · position.
std::shared_ptr<const mesh::Geometry> grid(int cells) {
  return test::with_own_uvs(test::open_grid(cells));
}

mesh::SurfaceMap map_of(const mesh::Geometry& geometry) {
  Progress progress;
  return mesh::bake_surface_map(geometry, kResolution, progress).value();
}

float u_of(const mesh::SurfaceMap& map, std::size_t slot, int texel) {
  const auto block = map.block_of_slot[slot] % static_cast<std::uint32_t>(map.blocks_per_side);
  return (static_cast<float>(block * kBlockSize) + static_cast<float>(texel % kBlockSize) + 0.5f) *
         kTexel;
}

// Selects the texels whose centers are to the left of a line.
TexelSelection left_of(const mesh::SurfaceMap& map, float line) {
  TexelSelection selected(map.surface_mask.size(), 0);
  for (std::size_t slot = 0; slot < selected.size(); ++slot)
    for (int texel = 0; texel < 64; ++texel)
      if ((map.surface_mask[slot] >> texel & 1) != 0 && u_of(map, slot, texel) < line)
        selected[slot] |= std::uint64_t{1} << texel;
  return selected;
}

std::vector<std::uint32_t> triangles_of(const mesh::Geometry& geometry,
                                        const TexelSelection& selected) {
  Progress progress;
  auto indices = selected_triangles(geometry, kResolution, selected, progress);
  EXPECT_TRUE(indices);
  return std::move(*indices);
}

float middle(const mesh::Geometry& geometry, const std::uint32_t* corners) {
  return (geometry.vertices[corners[0]].uv.x + geometry.vertices[corners[1]].uv.x +
          geometry.vertices[corners[2]].uv.x) /
         3;
}

TEST(SelectedTriangles, own_a_selected_texel) {
  const auto geometry = grid(20);
  const auto map = map_of(*geometry);
  const TexelSelection selected = left_of(map, 0.42f);
  Progress progress;
  const auto owners = mesh::bake_texel_owners(*geometry, kResolution, progress).value();
  std::set<std::uint32_t> wanted;
  for (std::size_t slot = 0; slot < selected.size(); ++slot)
    for (std::uint64_t rest = selected[slot]; rest != 0; rest &= rest - 1)
      wanted.insert(owners.triangle[slot * 64 + static_cast<std::size_t>(std::countr_zero(rest))]);
  std::vector<std::uint32_t> indices;
  for (const std::uint32_t triangle : wanted)
    for (int corner = 0; corner < 3; ++corner)
      indices.push_back(geometry->indices[3 * triangle + static_cast<std::uint32_t>(corner)]);
  EXPECT_EQ(triangles_of(*geometry, selected), indices);
  EXPECT_GT(wanted.size(), 100u);
  EXPECT_LT(wanted.size(), geometry->triangle_count() * 2 / 3);
}

TEST(SelectedTriangles, that_are_smaller_than_texels_leave_no_holes) {
  const auto geometry = grid(400);  // about ten triangles for each texel
  const auto map = map_of(*geometry);
  EXPECT_EQ(triangles_of(*geometry, left_of(map, 2)), geometry->indices);
  EXPECT_TRUE(triangles_of(*geometry, left_of(map, 0)).empty());
  const auto indices = triangles_of(*geometry, left_of(map, 0.5f));
  std::size_t inside = 0, kept_inside = 0;
  for (std::size_t i = 0; i < geometry->indices.size(); i += 3)
    inside += middle(*geometry, &geometry->indices[i]) < 0.5f - kTexel;
  for (std::size_t i = 0; i < indices.size(); i += 3) {
    const float at = middle(*geometry, &indices[i]);
    kept_inside += at < 0.5f - kTexel;
    ASSERT_LT(at, 0.5f + kTexel);
  }
  EXPECT_EQ(kept_inside, inside);
}

TEST(SelectedTriangles, are_not_searched_after_a_cancellation) {
  const auto geometry = grid(20);
  const auto map = map_of(*geometry);
  Progress progress;
  progress.cancel();
  const auto ended = selected_triangles(*geometry, kResolution, left_of(map, 2), progress);
  ASSERT_FALSE(ended);
  EXPECT_EQ(ended.error().code, ErrorCode::cancelled);
}

}  // namespace
}  // namespace strata::query
