#include "query/regions/texel_balls.h"

#include <algorithm>
#include <bit>
#include <functional>
#include <limits>

#include "mesh/texels/slot_bits.h"

namespace strata::query {
namespace {

using mesh::kNoSlot;
using mesh::Way;

// The texels at the sides of a block.
constexpr std::uint64_t kLeft = 0x0101010101010101u, kRight = kLeft << 7, kLower = 0xff,
                        kUpper = kLower << 56;
constexpr float kInfinity = std::numeric_limits<float>::infinity();
// The greatest ratio of a path of steps to 8 neighbors and a straight line.
constexpr float kLongestPath = 1.0824f;

}  // namespace

TexelBalls::TexelBalls(const mesh::SurfaceMap& map, const mesh::TexelGraph& graph, double radius,
                       std::size_t max_texels)
    : map_(map),
      graph_(graph),
      radius_(static_cast<float>(radius)),
      max_texels_(max_texels),
      // At seams, a ball has few texels in many blocks.
      max_blocks_(256 + max_texels / 16),
      table_(std::bit_ceil(2 * max_blocks_), kNone) {}

std::span<const BlockTexels> TexelBalls::around(std::uint32_t start) {
  fill(start);
  found_.clear();
  for (const std::uint32_t index : touched_)
    if (const Block& block = blocks_[index]; block.reached != 0)
      found_.push_back({block.slot, block.reached});
  return found_;
}

std::span<const BlockTexels> TexelBalls::on_paths(std::uint32_t start) {
  fill(start);
  walk(start);
  found_.clear();
  for (const std::uint32_t index : touched_)
    if (const Block& block = blocks_[index]; block.walked != 0)
      found_.push_back({block.slot, block.walked});
  return found_;
}

void TexelBalls::forget() {
  blocks_.clear();
  std::ranges::fill(table_, kNone);
}

void TexelBalls::fill(std::uint32_t start) {
  if (blocks_.size() > max_blocks_ / 2) forget();
  const bool keeps_blocks = !blocks_.empty();
  fill_once(start);
  if (blocks_.size() < max_blocks_ || !keeps_blocks) return;
  // The blocks of other balls have left too little room for this one.
  forget();
  fill_once(start);
}

void TexelBalls::fill_once(std::uint32_t start) {
  ++ball_;
  texels_ = 0;
  touched_.clear();
  queue_.clear();
  const std::uint32_t first = index_of(start / 64), i = start % 64;
  center_ = {blocks_[first].x[i], blocks_[first].y[i], blocks_[first].z[i]};
  reach(first, std::uint64_t{1} << i);
  for (std::size_t next = 0; next < queue_.size() && texels_ < max_texels_; ++next)
    spread(queue_[next]);
}

// Notes that texels of a block are connected to the start.
void TexelBalls::reach(std::uint32_t index, std::uint64_t bits) {
  Block& block = blocks_[index];
  if (block.ball != ball_) {
    block.ball = ball_;
    block.inside = texels_inside(block);
    block.reached = block.waiting = 0;
    touched_.push_back(index);
  }
  const std::uint64_t fresh = bits & block.inside & ~block.reached;
  if (fresh == 0) return;
  if (block.waiting == 0) queue_.push_back(index);
  block.waiting |= fresh;
}

std::uint64_t TexelBalls::texels_inside(const Block& block) const {
  const float distance = glm::distance(block.middle, center_);
  if (distance + block.reach <= radius_) return block.surface;
  if (distance - block.reach > radius_) return 0;
  std::array<float, 64> squared;
  for (std::size_t i = 0; i < 64; ++i) {
    const float x = block.x[i] - center_.x, y = block.y[i] - center_.y, z = block.z[i] - center_.z;
    squared[i] = x * x + y * y + z * z;
  }
  const float limit = radius_ * radius_;
  std::uint64_t inside = 0;
  for (std::size_t i = 0; i < 64; ++i)
    inside |= static_cast<std::uint64_t>(squared[i] <= limit) << i;
  return inside & block.surface;
}

// Finds the texels of a block that are connected to those that wait, and reaches from there to
// other blocks.
void TexelBalls::spread(std::uint32_t index) {
  Block& block = blocks_[index];
  const std::uint64_t right = block.to_right & ~kRight, upper = block.to_upper & ~kUpper;
  std::uint64_t all = block.reached | block.waiting;
  while (true) {
    const std::uint64_t grown =
        all | (((all & right) << 1 | (all >> 1 & right) | (all & upper) << 8 | (all >> 8 & upper)) &
               block.inside);
    if (grown == all) break;
    all = grown;
  }
  const std::uint64_t fresh = all & ~block.reached;
  block.reached = all;
  block.waiting = 0;
  texels_ += static_cast<std::size_t>(std::popcount(fresh));

  if (const std::uint64_t out = fresh & block.to_right & kRight; out != 0)
    if (const std::uint32_t other = beside(index, Way::right); other != kNone)
      reach(other, out >> 7);
  if (const std::uint64_t out = fresh & block.to_upper & kUpper; out != 0)
    if (const std::uint32_t other = beside(index, Way::upper); other != kNone)
      reach(other, out >> 56);
  if (const std::uint64_t out = fresh & kLeft; out != 0)
    if (const std::uint32_t other = beside(index, Way::left); other != kNone)
      reach(other, out << 7 & blocks_[other].to_right);
  if (const std::uint64_t out = fresh & kLower; out != 0)
    if (const std::uint32_t other = beside(index, Way::lower); other != kNone)
      reach(other, out << 56 & blocks_[other].to_upper);
  if ((fresh & block.linked) == 0) return;
  const std::uint32_t slot = block.slot;
  for (std::size_t i = block.first_link;
       i < graph_.links.size() && graph_.links[i].first / 64 == slot; ++i) {
    const auto [from, to] = graph_.links[i];
    if ((fresh >> from % 64 & 1u) == 0) continue;
    if (const std::uint32_t other = index_of(to / 64); other != kNone)
      reach(other, std::uint64_t{1} << to % 64);
  }
}

template <class Visit>
void TexelBalls::for_each_neighbour(std::uint32_t index, std::uint32_t i, Visit&& visit) {
  const Block& block = blocks_[index];
  const auto has = [](std::uint64_t bits, std::uint32_t at) { return (bits >> at & 1u) != 0; };
  if (has(block.to_right, i)) {
    if (i % 8 < 7)
      visit(index, i + 1);
    else if (const std::uint32_t other = beside(index, Way::right); other != kNone)
      visit(other, i - 7);
  }
  if (has(block.to_upper, i)) {
    if (i < 56)
      visit(index, i + 8);
    else if (const std::uint32_t other = beside(index, Way::upper); other != kNone)
      visit(other, i - 56);
  }
  if (i % 8 > 0) {
    if (has(block.to_right, i - 1)) visit(index, i - 1);
  } else if (const std::uint32_t other = beside(index, Way::left);
             other != kNone && has(blocks_[other].to_right, i + 7)) {
    visit(other, i + 7);
  }
  if (i >= 8) {
    if (has(block.to_upper, i - 8)) visit(index, i - 8);
  } else if (const std::uint32_t other = beside(index, Way::lower);
             other != kNone && has(blocks_[other].to_upper, i + 56)) {
    visit(other, i + 56);
  }
  if (!has(block.linked, i)) return;
  for (const auto& [from, to] : graph_.links_of(block.slot * 64 + i))
    if (const std::uint32_t other = index_of(to / 64); other != kNone) visit(other, to % 64);
}

// Finds the texels of the current ball with a short path (Dijkstra 1959).
void TexelBalls::walk(std::uint32_t start) {
  for (const std::uint32_t index : touched_) {
    blocks_[index].walked = 0;
    blocks_[index].lengths.fill(kInfinity);
  }
  const auto place = [&](std::uint32_t index, std::uint32_t i) {
    return glm::vec3(blocks_[index].x[i], blocks_[index].y[i], blocks_[index].z[i]);
  };
  const std::uint32_t first = index_of(start / 64);
  blocks_[first].lengths[start % 64] = 0;
  open_.assign(1, {0.0f, first * 64 + start % 64});
  while (!open_.empty()) {
    const auto [length, at] = open_.front();
    std::ranges::pop_heap(open_, std::greater{});
    open_.pop_back();
    const std::uint32_t index = at / 64, i = at % 64;
    if (length > blocks_[index].lengths[i]) continue;
    blocks_[index].walked |= std::uint64_t{1} << i;
    const glm::vec3 from = place(index, i);
    const auto step_to = [&, length = length](std::uint32_t other, std::uint32_t j) {
      Block& block = blocks_[other];
      if (block.ball != ball_ || (block.reached >> j & 1u) == 0) return;
      const float path = length + glm::distance(from, place(other, j));
      if (path > kLongestPath * radius_ || path >= block.lengths[j]) return;
      block.lengths[j] = path;
      open_.emplace_back(path, other * 64 + j);
      std::ranges::push_heap(open_, std::greater{});
    };
    // Two steps reach the diagonal neighbors, also across a seam.
    for_each_neighbour(index, i, [&](std::uint32_t beside, std::uint32_t j) {
      step_to(beside, j);
      for_each_neighbour(beside, j, step_to);
    });
  }
}

std::uint32_t TexelBalls::beside(std::uint32_t index, Way way) {
  std::uint32_t& known = blocks_[index].beside[static_cast<std::size_t>(way)];
  if (known != kUnknown) return known;
  const auto block = static_cast<int>(map_.block_of_slot[blocks_[index].slot]);
  const int x = block % map_.blocks_per_side, y = block / map_.blocks_per_side;
  const int dx = way == Way::right  ? 1
                 : way == Way::left ? -1
                                    : 0,
            dy = way == Way::upper   ? 1
                 : way == Way::lower ? -1
                                     : 0;
  const std::uint32_t slot = mesh::slot_at(map_, x + dx, y + dy);
  return known = slot == kNoSlot ? kNone : index_of(slot);
}

std::uint32_t TexelBalls::index_of(std::uint32_t slot) {
  const std::size_t mask = table_.size() - 1;
  std::size_t at = slot * 0x9e3779b1u & mask;
  for (; table_[at] != kNone; at = (at + 1) & mask)
    if (blocks_[table_[at]].slot == slot) return table_[at];
  if (blocks_.size() == max_blocks_) return kNone;
  table_[at] = static_cast<std::uint32_t>(blocks_.size());
  read(slot);
  return table_[at];
}

void TexelBalls::read(std::uint32_t slot) {
  if (blocks_.capacity() == 0) blocks_.reserve(max_blocks_);  // references stay valid
  Block& block = blocks_.emplace_back();
  block.slot = slot;
  block.beside.fill(kUnknown);
  block.surface = map_.surface_mask[slot];
  block.to_right = graph_.to_right[slot];
  block.to_upper = graph_.to_upper[slot];
  block.linked = graph_.has_links[slot];
  block.ball = 0;
  if (block.linked != 0)
    block.first_link = static_cast<std::size_t>(
        std::ranges::lower_bound(graph_.links, slot * 64, {}, &mesh::TexelGraph::Link::first) -
        graph_.links.begin());
  glm::vec3 low(kInfinity), high = -low;
  for (int i = 0; i < 64; ++i) {
    const bool is_surface = (block.surface >> i & 1u) != 0;
    const glm::vec3 place = is_surface ? map_.position(slot, i) : glm::vec3(0);
    const auto at = static_cast<std::size_t>(i);
    block.x[at] = place.x;
    block.y[at] = place.y;
    block.z[at] = place.z;
    if (!is_surface) continue;
    low = glm::min(low, place);
    high = glm::max(high, place);
  }
  block.middle = (low + high) / 2.0f;
  block.reach = glm::distance(high, block.middle);
}

}  // namespace strata::query
