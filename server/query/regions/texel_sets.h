#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace strata::query {

// Sets of connected texels, as flat trees: union-find (Tarjan 1975) with path halving. `join` makes
// the lowest texel the root of a set, so the result does not depend on the order of the joins.
// `attach` lets the caller choose the root.
class TexelSets {
 public:
  static constexpr std::uint32_t kNone = 0xffffffffu;

  explicit TexelSets(std::size_t texels) : parent_(texels, kNone) {}
  void add(std::uint32_t texel) { parent_[texel] = texel; }
  bool has(std::uint32_t texel) const { return parent_[texel] != kNone; }
  bool is_root(std::uint32_t texel) const { return parent_[texel] == texel; }
  void join(std::uint32_t a, std::uint32_t b) {
    a = root(a);
    b = root(b);
    if (a != b) parent_[std::max(a, b)] = std::min(a, b);
  }
  // Joins a root, or a texel that was not added, to the set of another root, which stays.
  void attach(std::uint32_t texel, std::uint32_t to) { parent_[texel] = to; }
  std::uint32_t root(std::uint32_t texel) {
    while (parent_[texel] != texel) texel = parent_[texel] = parent_[parent_[texel]];
    return texel;
  }
  // After joins only: returns the parent of each texel: a root, itself, or a lower texel of its
  // set. kNone if the texel was not added.
  std::vector<std::uint32_t> take_parents() && { return std::move(parent_); }

 private:
  std::vector<std::uint32_t> parent_;
};

}  // namespace strata::query
