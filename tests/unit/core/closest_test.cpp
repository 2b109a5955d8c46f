#include "core/text/closest.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

namespace strata {
namespace {

using Names = std::vector<std::string>;

TEST(ClosestNames, a_name_with_a_typing_mistake_is_found) {
  const Names names{"moisture", "cracks", "pieces", "depth", "thickness"};
  EXPECT_EQ(closest_names("moistur", names), Names{"moisture"});
  EXPECT_EQ(closest_names("mositure", names), Names{"moisture"});  // two adjacent letters swapped
  EXPECT_EQ(closest_names("dept", names), Names{"depth"});
  EXPECT_EQ(closest_names("MOISTURE", names), Names{"moisture"});
  EXPECT_EQ(closest_names("crack", names), Names{"cracks"});
  EXPECT_EQ(closest_names("thick", names), Names{"thickness"});  // the beginning of the name
}

TEST(ClosestNames, case_and_accents_do_not_count) {
  const Names names{"Größe", "Depósito"};
  EXPECT_EQ(closest_names("grosse", names), Names{"Größe"});
  EXPECT_EQ(closest_names("deposito", names), Names{"Depósito"});
}

TEST(ClosestNames, the_most_similar_one_comes_first_and_each_once) {
  const Names names{"wetness", "wet2", "wet1", "wet1", "welt"};
  EXPECT_EQ(closest_names("wet", names), (Names{"wet2", "wet1", "welt"}));
  EXPECT_EQ(closest_names("wet", names, 1), Names{"wet2"});
}

TEST(ClosestNames, names_that_have_little_in_common_are_not_suggested) {
  const Names names{"moisture", "cracks", "a", "ab", "x"};
  for (const char* wrong : {"salt", "temperature", "q", "zz", "", "colour"})
    EXPECT_TRUE(closest_names(wrong, names).empty()) << wrong;
  EXPECT_TRUE(closest_names("cracks", Names{"cracks"}).empty());  // already correct
}

TEST(ClosestNames, long_and_damaged_names_are_not_compared) {
  const std::string name(100, 'a'), long_name(101, 'a'), damaged = "w\xff";
  EXPECT_TRUE(closest_names(long_name, Names{name}).empty());
  EXPECT_TRUE(closest_names(name.substr(1), Names{long_name}).empty());
  EXPECT_EQ(closest_names(name.substr(1), Names{name}), Names{name});
  EXPECT_TRUE(closest_names(damaged, Names{"moisture"}).empty());
}

// Returns the distance by its plain recursive definition.
std::size_t oracle(std::string_view a, std::string_view b) {
  if (a.empty() || b.empty()) return a.size() + b.size();
  const auto a1 = a.substr(1), b1 = b.substr(1);
  std::size_t least =
      std::min({oracle(a1, b) + 1, oracle(a, b1) + 1, oracle(a1, b1) + (a[0] == b[0] ? 0u : 1u)});
  if (a.size() > 1 && b.size() > 1 && a[0] == b[1] && a[1] == b[0])
    least = std::min(least, oracle(a.substr(2), b.substr(2)) + 1);
  return least;
}

TEST(ClosestNames, the_distance_is_that_of_the_recursive_definition) {
  std::mt19937 random(7);
  const auto word = [&] {
    std::string text(4 + random() % 3, 'a');
    for (char& c : text) c = static_cast<char>('a' + random() % 3);
    return text;
  };
  int found = 0;
  for (int round = 0; round < 400; ++round) {
    const std::string wrong = word(), name = word();
    if (wrong == name) continue;
    const std::size_t limit = wrong.size() / 3, shorter = std::min(wrong.size(), name.size());
    const bool begins = wrong.substr(0, shorter) == name.substr(0, shorter);
    const bool expected = oracle(wrong, name) <= limit || begins;
    EXPECT_EQ(!closest_names(wrong, Names{name}).empty(), expected) << wrong << " " << name;
    found += expected;
  }
  EXPECT_GT(found, 20);
}

}  // namespace
}  // namespace strata
