// The order of blocks by their position on the model.
#include "mesh/surface/block_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <set>

namespace strata::mesh {
namespace {

constexpr float kTexel = 0.5f;
constexpr float kGap = 4 * kTexel;

// Returns the texels of a flat block with the given corner.
std::array<glm::vec3, 64> flat_block(const glm::vec3& corner) {
  std::array<glm::vec3, 64> positions;
  for (int i = 0; i < 64; ++i)
    positions[static_cast<std::size_t>(i)] = corner + kTexel * glm::vec3(i % 8, i / 8, 0);
  return positions;
}

std::vector<BoundedPart> parts_of(const std::array<glm::vec3, 64>& positions, std::uint64_t owned) {
  std::vector<BoundedPart> parts;
  const BoundingSphere bounds = bounds_of(positions.data(), owned, 1e-6f);
  add_parts_of_block({{7, 3, 21, false}, bounds}, positions.data(), owned, kGap, 1e-6f, parts);
  return parts;
}

TEST(PartsOfABlock, are_one_where_the_surface_is_one) {
  const auto block = flat_block({3, 4, 5});
  for (const std::uint64_t owned :
       {~std::uint64_t{0}, std::uint64_t{1}, std::uint64_t{0x0303}, std::uint64_t{0xff}}) {
    const auto parts = parts_of(block, owned);
    ASSERT_EQ(parts.size(), 1u);
    EXPECT_EQ(parts[0].part.slot, 7u);
    EXPECT_EQ(parts[0].part.tile, 3u);
    EXPECT_EQ(parts[0].part.place, 21u);
    EXPECT_FALSE(parts[0].part.shares_block);
  }
}

TEST(PartsOfABlock, are_small_where_islands_of_far_places_meet) {
  auto block = flat_block({0, 0, 0});
  const auto far = flat_block({100, 0, 0}), high = flat_block({0, 0, 300});
  for (std::size_t i = 0; i < 64; ++i) {
    if (i % 8 >= 4) block[i] = far[i];
    if (i >= 48) block[i] = high[i];
  }
  const auto parts = parts_of(block, ~std::uint64_t{0});
  ASSERT_EQ(parts.size(), 3u);
  for (const auto& part : parts) {
    EXPECT_TRUE(part.part.shares_block);
    EXPECT_LT(part.bounds.radius, 8 * kTexel);
  }
  for (const glm::vec3& position : block)
    EXPECT_TRUE(std::ranges::any_of(parts, [&](const BoundedPart& part) {
      return glm::length(position - part.bounds.center) <= part.bounds.radius;
    }));
}

TEST(PartsOfABlock, are_few_however_scattered_its_texels_are) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> place(0, 1000);
  for (int round = 0; round < 200; ++round) {
    std::array<glm::vec3, 64> block;
    for (auto& position : block) position = {place(random), place(random), place(random)};
    std::uint64_t owned = 0;
    while (owned == 0) owned = std::uint64_t{random()} << 32 | random();
    const auto parts = parts_of(block, owned);
    EXPECT_LE(parts.size(), 4u);
    for (std::size_t i = 0; i < 64; ++i)
      if (owned >> i & 1) {
        EXPECT_TRUE(std::ranges::any_of(parts, [&](const BoundedPart& part) {
          return glm::length(block[i] - part.bounds.center) <= part.bounds.radius;
        }));
      }
  }
}

class TreeOfMany : public testing::TestWithParam<std::size_t> {};

TEST_P(TreeOfMany, holds_every_part_once_under_bounds_that_hold_it) {
  std::mt19937 random(2);
  std::uniform_real_distribution<float> place(-50, 50);
  std::vector<BoundedPart> parts;
  for (std::uint32_t i = 0; i < GetParam(); ++i)
    parts.push_back({{i, 0, 0, false}, {{place(random), place(random), place(random)}, 0.1f}});
  const auto tree = build_block_tree(parts, 1e-5f, 3);
  ASSERT_EQ(tree.parts.size(), parts.size());
  std::set<std::uint32_t> seen;
  for (std::size_t i = 0; i < tree.parts.size(); ++i) {
    seen.insert(tree.parts[i].slot);
    const BoundingSphere& leaf = parts[tree.parts[i].slot].bounds;
    EXPECT_EQ(tree.levels[0][i].center, leaf.center);
    std::size_t node = i;
    for (const auto& level : tree.levels) {
      ASSERT_LE(glm::length(leaf.center - level[node].center) + leaf.radius,
                level[node].radius + 1e-4f);
      node /= BlockTree::kChildren;
    }
    EXPECT_EQ(node, i >> (3 * tree.levels.size()));
  }
  EXPECT_EQ(seen.size(), parts.size());
  EXPECT_EQ(tree.levels.empty(), parts.empty());
  if (!parts.empty()) {
    EXPECT_EQ(tree.levels.back().size(), 1u);
  }
}
INSTANTIATE_TEST_SUITE_P(Sizes, TreeOfMany, testing::Values(0, 1, 7, 8, 9, 64, 65, 513, 5000));

// The points form a cube of 16³. A run of eight neighbors must fill about a cube of 2³, not a slice
// of the whole cube.
TEST(BlockTree, keeps_neighbours_in_space_together) {
  std::vector<BoundedPart> parts;
  for (std::uint32_t i = 0; i < 4096; ++i)
    parts.push_back({{i, 0, 0, false}, {glm::vec3(i % 16, i / 16 % 16, i / 256), 0}});
  std::shuffle(parts.begin(), parts.end(), std::mt19937(3));
  const auto tree = build_block_tree(parts, 0, 2);
  ASSERT_EQ(tree.levels.size(), 5u);
  for (const auto& run : tree.levels[1]) EXPECT_LT(run.radius, 2.0f);
  for (const auto& run : tree.levels[2]) EXPECT_LT(run.radius, 4.0f);
}

}  // namespace
}  // namespace strata::mesh
