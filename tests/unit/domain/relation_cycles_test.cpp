// Cycles of relations, compared with an oracle that follows every key.
#include "domain/tables/relation_cycles.h"

#include <gtest/gtest.h>

#include <functional>
#include <random>
#include <set>

namespace strata {
namespace {

using Cycles = std::vector<std::vector<std::int64_t>>;

TEST(RelationCycles, a_key_above_itself_is_found_whatever_lies_between) {
  EXPECT_EQ(relation_cycles({}), Cycles{});
  EXPECT_EQ(relation_cycles({{1, {2, 3}}, {2, {3}}, {3, {4}}}), Cycles{});
  EXPECT_EQ(relation_cycles({{5, {5}}}), (Cycles{{5}}));
  EXPECT_EQ(relation_cycles({{3, {1}}, {1, {2}}, {2, {3, 9}}, {9, {2}}}), (Cycles{{1, 2, 3}}));
  EXPECT_EQ(relation_cycles({{1, {2}}, {2, {1}}, {7, {8}}, {8, {7}}, {2000, {1, 7}}}),
            (Cycles{{1, 2}, {7, 8}}));
}

TEST(RelationCycles, long_chains_need_no_deep_stack) {
  Relation chain;
  for (std::int64_t key = 1; key < 200'000; ++key) chain[key] = {key + 1};
  EXPECT_EQ(relation_cycles(chain), Cycles{});
  chain[200'000] = {1};
  ASSERT_EQ(relation_cycles(chain).size(), 1u);
  EXPECT_EQ(relation_cycles(chain)[0].size(), 200'000u);
}

TEST(RelationCycles, random_relations_have_the_knots_that_following_every_key_finds) {
  std::mt19937 random(5);
  for (int round = 0; round < 300; ++round) {
    Relation relation;
    const std::int64_t keys = 2 + random() % 12;
    for (std::int64_t key = 1; key <= keys; ++key)
      for (unsigned n = random() % 3; n > 0; --n)
        relation[key].push_back(1 + static_cast<std::int64_t>(random()) % keys);
    const auto reached = [&](std::int64_t from) {
      std::set<std::int64_t> found;
      std::function<void(std::int64_t)> follow = [&](std::int64_t key) {
        if (const auto named = relation.find(key); named != relation.end())
          for (const auto other : named->second)
            if (found.insert(other).second) follow(other);
      };
      follow(from);
      return found;
    };
    std::set<std::int64_t> expected, got;  // the lowest key of each cycle
    for (std::int64_t key = 1; key <= keys; ++key) {
      const auto down = reached(key);
      if (!down.contains(key)) continue;
      bool lowest = true;
      for (std::int64_t other = 1; other < key; ++other)
        if (down.contains(other) && reached(other).contains(key)) lowest = false;
      if (lowest) expected.insert(key);
    }
    for (const auto& cycle : relation_cycles(relation)) {
      got.insert(cycle.front());
      for (std::size_t i = 0; i < cycle.size(); ++i) {
        const auto& named = relation.at(cycle[i]);
        EXPECT_NE(std::find(named.begin(), named.end(), cycle[(i + 1) % cycle.size()]),
                  named.end());
      }
    }
    EXPECT_EQ(got, expected);
  }
}

}  // namespace
}  // namespace strata
