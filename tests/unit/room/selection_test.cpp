// Combinations of selections: brute force over texels, and the layers that a tree of parts reads.
#include "room/selection.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <random>
#include <vector>

#include "expression/expression_parser.h"

namespace strata::room {
namespace {

using ::testing::ElementsAre;
using ::testing::UnorderedElementsAre;

constexpr std::size_t kSlots = 50;

query::TexelSelection random_selection(std::mt19937_64& random) {
  query::TexelSelection selection(kSlots);
  for (std::uint64_t& bits : selection) bits = random();
  return selection;
}

bool has(const query::TexelSelection& selection, std::size_t texel) {
  return (selection[texel / 64] >> texel % 64 & 1u) != 0;
}

TEST(CombinedSelections, are_those_of_brute_force) {
  std::mt19937_64 random(7);
  for (int round = 0; round < 20; ++round) {
    query::TexelSelection selected = random_selection(random);
    std::vector<bool> expected(kSlots * 64);
    for (std::size_t texel = 0; texel < expected.size(); ++texel)
      expected[texel] = has(selected, texel);
    for (int step = 0; step < 5; ++step) {
      const auto combination = static_cast<Combination>(random() % 3);
      const query::TexelSelection other = random_selection(random);
      combine(selected, other, combination);
      for (std::size_t texel = 0; texel < expected.size(); ++texel) {
        const bool before = expected[texel], in_other = has(other, texel);
        if (combination == Combination::add)
          expected[texel] = before || in_other;
        else if (combination == Combination::subtract)
          expected[texel] = before && !in_other;
        else
          expected[texel] = before && in_other;
      }
    }
    for (std::size_t texel = 0; texel < expected.size(); ++texel)
      ASSERT_EQ(has(selected, texel), expected[texel]) << texel;
  }
}

Region like(const std::string& layer, const std::string& field) {
  Selection::Like like;
  like.by = Selection::Like::By::value;
  like.layer = layer;
  return {like, 0, 0, field};
}

TEST(LayersOfASelection, are_found_in_all_its_parts) {
  Selection selection;
  selection.where = *query::parse_condition("moisture > 1", "where");
  Selection::Combined inner;
  inner.parts.push_back(like("depth", "deep"));
  inner.parts.push_back({Selection::Where{*query::parse_condition("cracks = 2", "where")}});
  inner.parts.back().combination = Combination::subtract;
  Selection::Combined outer;
  outer.parts.push_back(like("salt", "first"));
  outer.parts.push_back({std::move(inner)});
  outer.parts.back().combination = Combination::intersect;
  selection.within = Region{std::move(outer)};
  EXPECT_THAT(layers_read_by(selection),
              UnorderedElementsAre("moisture", "depth", "cracks", "salt"));
  std::vector<std::string> compared;
  for (const LayerRead& read : layers_compared(selection))
    compared.push_back(read.field + ": " + read.slug);
  EXPECT_THAT(compared, ElementsAre("first.like.layer: salt", "deep.like.layer: depth"));
}

TEST(LayersOfASelection, are_none_for_the_whole_surface) {
  EXPECT_TRUE(layers_read_by({}).empty());
  EXPECT_TRUE(layers_compared({}).empty());
}

}  // namespace
}  // namespace strata::room
