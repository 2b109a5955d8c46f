#include "mesh/distance/block_front.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>

#include "mesh/texels/slot_bits.h"

namespace strata::mesh {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
// A distance must become smaller by this share of a step. Otherwise rounding errors could move
// fronts again and again.
constexpr double kLeastGain = 1e-4;

}  // namespace

std::uint64_t BlockFront::move(std::uint32_t slot, const std::vector<SeamTriangle>& seam,
                               SurfaceDistances::Block& block) {
  load(slot);
  find_neighbours();
  measure_sides();
  nearer_ = 0;
  queue_.clear();
  const bool is_new = !known_.has_block(slot);
  for (int cell = 0; cell < kCells; ++cell) {
    const bool inside =
        cell % kWide > 0 && cell % kWide < kWide - 1 && cell >= kWide && cell < kCells - kWide;
    if (distance_[cell] <= limit_ && (is_new || !inside))
      queue_.emplace_back(distance_[cell], cell);
  }
  std::ranges::make_heap(queue_, std::greater{});
  do {
    while (!queue_.empty()) {
      const auto [distance, cell] = queue_.front();
      std::ranges::pop_heap(queue_, std::greater{});
      queue_.pop_back();
      if (distance == distance_[cell]) move_from(cell);
    }
    move_across_seams(slot, seam);
  } while (!queue_.empty());
  for (int texel = 0; texel < 64; ++texel) {
    block.distance[texel] = distance_[cell_of(texel)];
    block.source[texel] = source_[cell_of(texel)];
  }
  return nearer_;
}

void BlockFront::load(std::uint32_t slot) {
  const auto block = static_cast<int>(map_.block_of_slot[slot]);
  const int x = block % map_.blocks_per_side, y = block / map_.blocks_per_side;
  distance_.fill(kInfinity);
  source_.fill(kNoNeighbour);
  present_.fill(false);
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx) {
      const std::uint32_t beside = slot_at(map_, x + dx, y + dy);
      if (beside == kNoSlot) continue;
      const int first_x = dx < 0 ? 7 : 0, last_x = dx > 0 ? 0 : 7;
      const int first_y = dy < 0 ? 7 : 0, last_y = dy > 0 ? 0 : 7;
      for (int in_y = first_y; in_y <= last_y; ++in_y)
        for (int in_x = first_x; in_x <= last_x; ++in_x)
          load_texel((dy * 8 + in_y + 1) * kWide + dx * 8 + in_x + 1, beside,
                     static_cast<std::uint32_t>(in_y * 8 + in_x));
    }
}

void BlockFront::load_texel(int cell, std::uint32_t slot, std::uint32_t texel) {
  const auto has = [&](const std::vector<std::uint64_t>& bits) {
    return (bits[slot] >> texel & 1u) != 0;
  };
  if (!has(map_.surface_mask)) return;
  present_[cell] = true;
  to_right_[cell] = has(graph_.to_right);
  to_upper_[cell] = has(graph_.to_upper);
  position_[cell] = map_.position(slot, static_cast<int>(texel));
  const TexelDistance stored = known_.stored(slot * 64 + texel);
  distance_[cell] = stored.distance;
  source_[cell] = stored.source;
}

void BlockFront::find_neighbours() {
  const auto right = [&](int cell) { return present_[cell] && to_right_[cell]; };
  const auto upper = [&](int cell) { return present_[cell] && to_upper_[cell]; };
  for (int texel = 0; texel < 64; ++texel) {
    const int c = cell_of(texel);
    std::uint8_t ring = 0;
    if (present_[c]) {
      const bool r = right(c), u = upper(c), l = right(c - 1), d = upper(c - kWide);
      const std::array<bool, 8> connected{
          r, (r && upper(c + 1)) || (u && right(c + kWide)),
          u, (l && upper(c - 1)) || (u && right(c + kWide - 1)),
          l, (l && upper(c - kWide - 1)) || (d && right(c - kWide - 1)),
          d, (r && upper(c - kWide + 1)) || (d && right(c - kWide))};
      for (int k = 0; k < 8; ++k) ring |= static_cast<std::uint8_t>(connected[k] << k);
    }
    ring_[kMargin + c] = ring;
  }
}

void BlockFront::measure_sides() {
  for (int way = 0; way < 4; ++way)
    for (int cell = 0; cell < kCells - kRing[way]; ++cell)
      if (present_[cell] && present_[cell + kRing[way]])
        sides_[way][cell] = glm::distance(position_[cell], position_[cell + kRing[way]]);
}

float BlockFront::side(int cell, int way) const {
  return way < 4 ? sides_[way][cell] : sides_[way - 4][cell + kRing[way]];
}

// The length between two neighbors of a cell, whose ways differ by one or, between neighbors on the
// axes, by two.
float BlockFront::across(int cell, int first, int second) const {
  // The ways from the neighbor `first` to the next one, and to the one after it.
  constexpr std::array<int, 8> kNext{2, 4, 4, 6, 6, 0, 0, 2}, kAfterNext{3, 0, 5, 0, 7, 0, 1, 0};
  const bool forward = ((second - first) & 7) < 4;
  const int from = forward ? first : second, turn = (forward ? second - first : first - second) & 7;
  return side(cell + kRing[from], turn == 1 ? kNext[from] : kAfterNext[from]);
}

// Updates the neighbors of a cell.
void BlockFront::move_from(int cell) {
  for (int way = 0; way < 8; ++way) {
    const int to = cell - kRing[way];
    if ((ring_[kMargin + to] >> way & 1) == 0 || distance_[to] <= distance_[cell]) continue;
    update(to, way);
  }
}

// Updates a cell from its neighbor in one direction, and from the triangles with this neighbor.
void BlockFront::update(int cell, int way) {
  const int from = cell + kRing[way];
  const float length = side(cell, way);
  lower(cell, double{distance_[from]} + double{length}, source_[from], length);
  for (const int turn : {-2, -1, 1, 2}) {
    if (std::abs(turn) == 2 && way % 2 != 0) continue;
    const int other = (way + turn) & 7;
    if ((ring_[kMargin + cell] >> other & 1) == 0) continue;
    const int b = cell + kRing[other];
    const double between = across(cell, way, other);
    if (distance_[b] < kInfinity && between > 0)
      cross(cell, {length, side(cell, other), between}, {distance_[from], source_[from]},
            {distance_[b], source_[b]});
  }
}

// Updates a cell from a triangle with the distances of its other corners. The distance from one
// source is exact. Between the sources of a line, whose fronts are narrow, only a planar front is
// accurate.
void BlockFront::cross(int cell, const FrontTriangle& sides, const TexelDistance& a,
                       const TexelDistance& b) {
  const bool one_source = a.source == b.source && (a.source & kManySources) == 0;
  const Front front = one_source ? circular_front(sides, a.distance, b.distance)
                                 : planar_front(sides, a.distance, b.distance);
  std::uint32_t source = (front.from_a ? a : b).source;
  if (a.source != b.source) source |= kManySources;
  lower(cell, front.distance, source, std::min(sides.ca, sides.cb));
}

void BlockFront::lower(int cell, double distance, std::uint32_t source, double side) {
  const auto rounded = static_cast<float>(distance);
  if (!(rounded <= limit_) || rounded >= distance_[cell] - kLeastGain * side) return;
  distance_[cell] = rounded;
  source_[cell] = source;
  nearer_ |= std::uint64_t{1} << ((cell / kWide - 1) * 8 + cell % kWide - 1);
  queue_.emplace_back(distance_[cell], cell);
  std::ranges::push_heap(queue_, std::greater{});
}

void BlockFront::move_across_seams(std::uint32_t slot, const std::vector<SeamTriangle>& seam) {
  const auto known = [&](std::uint32_t texel) -> TexelDistance {
    if (texel == kNoNeighbour) return {kInfinity, kNoNeighbour};
    if (texel / 64 != slot) return known_.stored(texel);
    const int cell = cell_of(static_cast<int>(texel % 64));
    return {distance_[cell], source_[cell]};
  };
  for (const SeamTriangle& t : seam) {
    const TexelDistance a = known(t.a), b = known(t.b);
    const int cell = cell_of(static_cast<int>(t.texel % 64));
    if (std::min(a.distance, b.distance) >= distance_[cell]) continue;
    if (t.b == kNoNeighbour) {
      lower(cell, double{a.distance} + double{t.to_a}, a.source, t.to_a);
    } else if (std::max(a.distance, b.distance) < kInfinity) {
      cross(cell, {t.to_a, t.to_b, t.a_to_b}, a, b);
    }
  }
}

}  // namespace strata::mesh
