#include "query/statistics/perimeter.h"

#include <algorithm>
#include <bit>
#include <unordered_map>
#include <vector>

#include "core/progress.h"
#include "mesh/parallel.h"
#include "mesh/texels/texel_graph.h"
#include "query/conditions/texel_values.h"
#include "query/statistics/border_lines.h"

namespace strata::query {
namespace {

using mesh::kNoNeighbour;

// The class of each surface texel of the map.
class Classes {
 public:
  Classes(const LayerView& view, const mesh::SurfaceMap& map, const TexelSelection* within,
          const ValueClasses& classes)
      : is_one_(!classes.each && classes.limits.empty()), valid_(map.block_of_slot.size()) {
    if (!is_one_) class_of_.resize(map.block_of_slot.size() * 64);
    for (const auto& [address, tile] : view.snapshot.tiles)
      for_each_value(*tile, address, view.layer.type, map, within,
                     [&](std::uint32_t slot, int texel, std::uint32_t bits, double value) {
                       valid_[slot] |= std::uint64_t{1} << texel;
                       if (!is_one_)
                         class_of_[slot * 64 + std::uint32_t(texel)] = classes.of(bits, value);
                     });
  }
  bool is_valid(std::uint32_t texel) const { return (valid_[texel / 64] >> texel % 64 & 1u) != 0; }
  std::uint32_t of(std::uint32_t texel) const { return is_one_ ? 0 : class_of_[texel]; }
  bool is_empty(std::uint32_t slot) const { return valid_[slot] == 0; }
  bool is_full_of(std::uint32_t slot, std::uint32_t a_class) const {
    if (valid_[slot] != ~std::uint64_t{0}) return false;
    const auto first = class_of_.begin() + std::ptrdiff_t{slot} * 64;
    return is_one_ ||
           std::all_of(first, first + 64, [&](std::uint32_t each) { return each == a_class; });
  }

 private:
  bool is_one_;
  std::vector<std::uint64_t> valid_;
  // classes of valid texels; empty if there is only one class
  std::vector<std::uint32_t> class_of_;
};

struct Sums {
  double all = 0;
  std::unordered_map<std::uint32_t, double> of_class{};
};

class Measuring {
 public:
  Measuring(const Classes& classes, const mesh::SurfaceMap& map, const mesh::TexelGraph& graph)
      : classes_(classes), map_(map), graph_(graph), lines_(map, graph) {}

  void measure(std::uint32_t slot, Sums& sums) const {
    if (has_no_border(slot)) return;
    for (std::uint64_t left = map_.surface_mask[slot]; left != 0; left &= left - 1)
      measure_texel(slot * 64 + static_cast<std::uint32_t>(std::countr_zero(left)), sums);
  }

 private:
  // Checks the neighboring blocks too, because lines extend over two texels.
  bool has_no_border(std::uint32_t slot) const {
    bool empty = graph_.has_links[slot] == 0, full = empty && classes_.is_valid(slot * 64);
    const std::uint32_t a_class = full ? classes_.of(slot * 64) : 0;
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const std::uint32_t beside = slot_beside(slot, dx, dy);
        if (beside == mesh::kNoSlot) {
          full = false;
          continue;
        }
        empty = empty && classes_.is_empty(beside) && graph_.has_links[beside] == 0;
        full = full && map_.surface_mask[beside] == ~std::uint64_t{0} &&
               classes_.is_full_of(beside, a_class);
      }
    return empty || full;
  }

  // Adds half of the border length of each pair of texels; the other texel of the pair adds the
  // other half.
  void measure_texel(std::uint32_t texel, Sums& sums) const {
    const bool valid = classes_.is_valid(texel);
    lines_.for_each_crossing(
        texel,
        [&](std::uint32_t other) { return other == kNoNeighbour ? valid : differs(texel, other); },
        [&](std::uint32_t other, double length) {
          if (other != kNoNeighbour) return add(texel, other, length / 2, sums);
          sums.all += length;  // no texel adds the other half
          sums.of_class[classes_.of(texel)] += length;
        });
  }

  bool differs(std::uint32_t a, std::uint32_t b) const {
    const bool valid = classes_.is_valid(a);
    return valid != classes_.is_valid(b) || (valid && classes_.of(a) != classes_.of(b));
  }

  void add(std::uint32_t a, std::uint32_t b, double length, Sums& sums) const {
    const bool a_valid = classes_.is_valid(a), b_valid = classes_.is_valid(b);
    if (a_valid != b_valid) sums.all += length;
    if (a_valid) sums.of_class[classes_.of(a)] += length;
    if (b_valid) sums.of_class[classes_.of(b)] += length;
  }

  // Returns kNoSlot if the block is empty.
  std::uint32_t slot_beside(std::uint32_t slot, int dx, int dy) const {
    const auto block = static_cast<int>(map_.block_of_slot[slot]);
    const int x = block % map_.blocks_per_side + dx, y = block / map_.blocks_per_side + dy;
    if (x < 0 || y < 0 || x >= map_.blocks_per_side || y >= map_.blocks_per_side)
      return mesh::kNoSlot;
    return map_.slot_of_block[static_cast<std::size_t>(y) * map_.blocks_per_side + x];
  }

  const Classes& classes_;
  const mesh::SurfaceMap& map_;
  const mesh::TexelGraph& graph_;
  const BorderLines lines_;
};

}  // namespace

Perimeters measure_perimeters(const LayerView& view, const mesh::SurfaceMap& map,
                              const mesh::TexelGraph& graph, const TexelSelection* within,
                              const ValueClasses& value_classes, int threads,
                              const Progress* progress) {
  const Classes classes(view, map, within, value_classes);
  const Measuring measuring(classes, map, graph);
  constexpr std::size_t kAtOnce = 1024;
  const std::size_t slots = map.block_of_slot.size();
  std::vector<Sums> parts((slots + kAtOnce - 1) / kAtOnce);
  mesh::parallel_for(threads, static_cast<int>(parts.size()), [&](int number) {
    if (progress && progress->cancelled()) return;
    const auto part = static_cast<std::size_t>(number);
    for (std::size_t slot = part * kAtOnce; slot < std::min(slots, (part + 1) * kAtOnce); ++slot)
      measuring.measure(static_cast<std::uint32_t>(slot), parts[part]);
  });
  Perimeters perimeters;
  for (const Sums& part : parts) {
    perimeters.all += part.all;
    for (const auto& [a_class, length] : part.of_class) perimeters.of_class[a_class] += length;
  }
  return perimeters;
}

}  // namespace strata::query
