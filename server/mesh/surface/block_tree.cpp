#include "mesh/surface/block_tree.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "mesh/longest_axis.h"
#include "mesh/parallel.h"

namespace strata::mesh {
namespace {

constexpr std::size_t kChildren = BlockTree::kChildren;
constexpr int kBins = 16;        // along a block's longest axis
constexpr int kMaxCuts = 2;      // consecutive cuts, so at most four parts per block
constexpr int kSerialDepth = 3;  // number of halvings before threads are used

struct Box {
  glm::vec3 low{std::numeric_limits<float>::max()}, high{std::numeric_limits<float>::lowest()};
  void add(const glm::vec3& center, float radius = 0) {
    low = glm::min(low, center - radius);
    high = glm::max(high, center + radius);
  }
};

Box box_of(const glm::vec3* positions, std::uint64_t texels) {
  Box box;
  for (; texels != 0; texels &= texels - 1) box.add(positions[std::countr_zero(texels)]);
  return box;
}

// Returns the texels below the widest gap along the box's longest axis if this gap is wide enough.
// Otherwise returns all texels.
std::uint64_t below_gap(const glm::vec3* positions, std::uint64_t texels, float least_gap) {
  const Box box = box_of(positions, texels);
  const int axis = longest_axis(box.high - box.low);
  const float extent = box.high[axis] - box.low[axis];
  if (!(extent > least_gap)) return texels;
  std::array<std::uint64_t, kBins> bins{};
  for (std::uint64_t rest = texels; rest != 0; rest &= rest - 1) {
    const int i = std::countr_zero(rest);
    const float place = (positions[i][axis] - box.low[axis]) / extent * kBins;
    bins[static_cast<std::size_t>(std::clamp(static_cast<int>(place), 0, kBins - 1))] |=
        std::uint64_t{1} << i;
  }
  std::uint64_t below = bins[0], best = texels;
  int widest = 0;
  for (int bin = 1, empty = 0; bin < kBins; ++bin) {
    const std::uint64_t here = bins[static_cast<std::size_t>(bin)];
    if (here == 0) {
      ++empty;
      continue;
    }
    if (empty > widest) widest = empty, best = below;
    empty = 0;
    below |= here;
  }
  return static_cast<float>(widest) * extent / kBins >= least_gap ? best : texels;
}

void cut(const glm::vec3* positions, std::uint64_t texels, float least_gap, int cuts_left,
         std::vector<std::uint64_t>& found) {
  const std::uint64_t below = cuts_left > 0 ? below_gap(positions, texels, least_gap) : texels;
  if (below == texels) {
    found.push_back(texels);
    return;
  }
  cut(positions, below, least_gap, cuts_left - 1, found);
  cut(positions, texels & ~below, least_gap, cuts_left - 1, found);
}

struct Range {
  std::size_t first = 0, last = 0;
  std::size_t size() const { return last - first; }
};

// Halves a range across the longest axis of its centers, at a whole number of subtrees. In the
// final order, eight neighbors are then the children of a node.
std::size_t halve(std::vector<BoundedPart>& parts, Range range) {
  std::size_t subtree = 1;
  while (subtree * kChildren < range.size()) subtree *= kChildren;
  const std::size_t subtrees = (range.size() + subtree - 1) / subtree;
  const std::size_t middle = range.first + subtrees / 2 * subtree;
  Box box;
  for (std::size_t i = range.first; i < range.last; ++i) box.add(parts[i].bounds.center);
  const int axis = longest_axis(box.high - box.low);
  const auto at = [&](std::size_t i) { return parts.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(range.first), at(middle), at(range.last),
                   [axis](const BoundedPart& a, const BoundedPart& b) {
                     return a.bounds.center[axis] < b.bounds.center[axis];
                   });
  return middle;
}

void order(std::vector<BoundedPart>& parts, Range range) {
  if (range.size() <= kChildren) return;
  const std::size_t middle = halve(parts, range);
  order(parts, {range.first, middle});
  order(parts, {middle, range.last});
}

std::vector<BoundingSphere> bound_runs(const std::vector<BoundingSphere>& children, float slack) {
  std::vector<BoundingSphere> runs;
  for (std::size_t first = 0; first < children.size(); first += kChildren) {
    const std::size_t last = std::min(first + kChildren, children.size());
    Box box;
    for (std::size_t i = first; i < last; ++i) box.add(children[i].center, children[i].radius);
    BoundingSphere run{(box.low + box.high) * 0.5f, 0};
    for (std::size_t i = first; i < last; ++i)
      run.radius = std::max(
          run.radius, glm::length(children[i].center - run.center) + children[i].radius + slack);
    runs.push_back(run);
  }
  return runs;
}

}  // namespace

std::size_t BlockTree::bytes() const {
  std::size_t total = parts.size() * sizeof(Part);
  for (const auto& level : levels) total += level.size() * sizeof(BoundingSphere);
  return total;
}

BoundingSphere bounds_of(const glm::vec3* positions, std::uint64_t owned, float slack) {
  const Box box = box_of(positions, owned);
  BoundingSphere bounds{(box.low + box.high) * 0.5f, 0};
  float farthest = 0;
  for (std::uint64_t rest = owned; rest != 0; rest &= rest - 1) {
    const glm::vec3 d = positions[std::countr_zero(rest)] - bounds.center;
    farthest = std::max(farthest, glm::dot(d, d));
  }
  bounds.radius = std::sqrt(farthest) + slack;
  return bounds;
}

void add_parts_of_block(BoundedPart whole, const glm::vec3* positions, std::uint64_t owned,
                        float least_gap, float slack, std::vector<BoundedPart>& parts) {
  std::vector<std::uint64_t> found;
  cut(positions, owned, least_gap, kMaxCuts, found);
  if (found.size() == 1) {
    parts.push_back(whole);
    return;
  }
  whole.part.shares_block = true;
  for (const std::uint64_t texels : found)
    parts.push_back({whole.part, bounds_of(positions, texels, slack)});
}

BlockTree build_block_tree(std::vector<BoundedPart> parts, float slack, int threads) {
  std::vector<Range> ranges{{0, parts.size()}};
  for (int depth = 0; depth < kSerialDepth; ++depth) {
    std::vector<Range> halves;
    for (const Range& range : ranges) {
      if (range.size() <= kChildren) continue;
      const std::size_t middle = halve(parts, range);
      halves.push_back({range.first, middle});
      halves.push_back({middle, range.last});
    }
    ranges = std::move(halves);
  }
  parallel_for(threads, static_cast<int>(ranges.size()),
               [&](int i) { order(parts, ranges[static_cast<std::size_t>(i)]); });

  BlockTree tree;
  if (parts.empty()) return tree;
  auto& leaves = tree.levels.emplace_back();
  tree.parts.reserve(parts.size());
  leaves.reserve(parts.size());
  for (const BoundedPart& part : parts) {
    tree.parts.push_back(part.part);
    leaves.push_back(part.bounds);
  }
  while (tree.levels.back().size() > 1)
    tree.levels.push_back(bound_runs(tree.levels.back(), slack));
  return tree;
}

}  // namespace strata::mesh
