#include "query/statistics/perimeter.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <unordered_map>
#include <vector>

#include "mesh/parallel.h"
#include "mesh/texels/texel_graph.h"
#include "query/conditions/texel_values.h"

namespace strata::query {
namespace {

using mesh::kNoNeighbour;
using mesh::Way;

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

constexpr std::size_t kDirections = 8;  // plus the opposite directions
constexpr std::array<std::array<int, 2>, kDirections> kDirection{
    {{1, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 1}, {-1, 2}, {-1, 1}, {-2, 1}}};

// The paths along the axes to the texel at an offset. Paths near the straight line come first.
struct Walk {
  int steps = 0;
  std::array<std::array<Way, 3>, 3> orders{};
  int order_count = 0;
};
Walk walk_along(int dx, int dy) {
  const Way across = dx < 0 ? Way::left : Way::right, up = dy < 0 ? Way::lower : Way::upper;
  switch (std::abs(dx) * 10 + std::abs(dy)) {
    case 10: return {1, {{{across}}}, 1};
    case 1: return {1, {{{up}}}, 1};
    case 11: return {2, {{{across, up}, {up, across}}}, 2};
    case 21: return {3, {{{across, up, across}, {across, across, up}, {up, across, across}}}, 3};
    default: return {3, {{{up, across, up}, {up, up, across}, {across, up, up}}}, 3};
  }
}

struct Sums {
  double all = 0;
  std::unordered_map<std::uint32_t, double> of_class{};
};

class Measuring {
 public:
  Measuring(const Classes& classes, const mesh::SurfaceMap& map, const mesh::TexelGraph& graph)
      : classes_(classes), map_(map), graph_(graph) {
    for (std::size_t k = 0; k < kDirections; ++k) {
      walks_[k] = walk_along(kDirection[k][0], kDirection[k][1]);
      walks_[k + kDirections] = walk_along(-kDirection[k][0], -kDirection[k][1]);
    }
  }

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
    Surroundings around(*this, texel);
    const bool valid = classes_.is_valid(texel);
    for (std::size_t direction = 0; direction < walks_.size(); ++direction) {
      std::uint32_t other = walk(texel, walks_[direction]);
      if (other == kNoNeighbour) other = around.beyond_seam(direction);
      if (other != kNoNeighbour) {
        if (differs(texel, other)) add(texel, other, around.weight(direction) / 2, sums);
      } else if (valid && around.is_at_open_edge()) {  // no texel adds the other half
        sums.all += around.weight(direction);
        sums.of_class[classes_.of(texel)] += around.weight(direction);
      }
    }
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

  // Returns kNoNeighbour if the island ends before the end of the walk.
  std::uint32_t walk(std::uint32_t texel, const Walk& walk) const {
    for (int order = 0; order < walk.order_count; ++order) {
      std::uint32_t at = texel;
      for (int i = 0; i < walk.steps && at != kNoNeighbour; ++i)
        at = step(at, walk.orders[order][i]);
      if (at != kNoNeighbour) return at;
    }
    return kNoNeighbour;
  }

  std::uint32_t step(std::uint32_t texel, Way way) const {
    return mesh::neighbour(map_, graph_, texel, way);
  }

  // Returns kNoSlot if the block is empty.
  std::uint32_t slot_beside(std::uint32_t slot, int dx, int dy) const {
    const auto block = static_cast<int>(map_.block_of_slot[slot]);
    const int x = block % map_.blocks_per_side + dx, y = block / map_.blocks_per_side + dy;
    if (x < 0 || y < 0 || x >= map_.blocks_per_side || y >= map_.blocks_per_side)
      return mesh::kNoSlot;
    return map_.slot_of_block[static_cast<std::size_t>(y) * map_.blocks_per_side + x];
  }

  glm::dvec3 place(std::uint32_t texel) const {
    return glm::dvec3(map_.position(texel / 64, static_cast<int>(texel % 64)));
  }

  // The properties of a texel that are computed only near a border.
  class Surroundings {
   public:
    Surroundings(const Measuring& measuring, std::uint32_t texel)
        : measuring_(measuring), texel_(texel) {}

    // Returns the border length that a pair of texels in this direction represents.
    double weight(std::size_t direction) {
      if (!weights_) weights_ = weigh();
      return (*weights_)[direction % kDirections];
    }

    bool is_at_open_edge() { return reach().at_open_edge; }

    // Returns the texel across a seam in this direction, or kNoNeighbour if the seam has no other
    // side.
    std::uint32_t beyond_seam(std::size_t direction) {
      if (reach().over_seam.empty()) return kNoNeighbour;
      const auto& [x, y] = sides();
      const auto [dx, dy] = kDirection[direction % kDirections];
      const glm::dvec3 way =
          (direction < kDirections ? 1.0 : -1.0) * (double(dx) * x + double(dy) * y);
      const glm::dvec3 here = measuring_.place(texel_);
      double nearest = std::numeric_limits<double>::infinity();
      std::uint32_t found = kNoNeighbour;
      for (const std::uint32_t other : reach().over_seam) {
        const glm::dvec3 there = measuring_.place(other) - here;
        // Where a seam ends at an open edge, this direction may lead to the seam or to the open
        // edge.
        if (is_at_open_edge() && glm::dot(there, way) < 0.5 * glm::length(there) * glm::length(way))
          continue;
        const double apart = glm::length(there - way);
        if (apart >= nearest) continue;
        nearest = apart;
        found = other;
      }
      return found;
    }

   private:
    struct Reach {
      std::vector<std::uint32_t> over_seam;
      bool at_open_edge = false;
    };
    // Returns the texels that a path of at most three steps reaches.
    const Reach& reach() {
      if (reach_) return *reach_;
      reach_.emplace();
      struct Reached {
        std::uint32_t texel;
        bool over;
      };
      std::vector<Reached> reached{{texel_, false}};
      std::size_t first = 0;
      for (int step = 0; step < 3; ++step) {
        const std::size_t last = reached.size();
        for (; first < last; ++first) {
          const Reached from = reached[first];
          mesh::for_each_neighbour(
              measuring_.map_, measuring_.graph_, from.texel, [&](std::uint32_t next) {
                if (std::ranges::find(reached, next, &Reached::texel) != reached.end()) return;
                reached.push_back({next, from.over || !are_beside(from.texel, next)});
              });
        }
      }
      for (const auto& [each, over] : reached) {
        if (over) reach_->over_seam.push_back(each);
        reach_->at_open_edge |=
            !over && (measuring_.graph_.at_open_edge[each / 64] >> each % 64 & 1u) != 0;
      }
      return *reach_;
    }
    bool are_beside(std::uint32_t a, std::uint32_t b) const {
      return std::ranges::any_of(std::array{Way::right, Way::upper, Way::left, Way::lower},
                                 [&](Way way) { return measuring_.step(a, way) == b; });
    }

    std::array<double, kDirections> weigh() {
      const auto& [along_x, along_y] = sides();
      const double xx = glm::dot(along_x, along_x), xy = glm::dot(along_x, along_y),
                   yy = glm::dot(along_y, along_y);
      const double area = std::sqrt(std::max(xx * yy - xy * xy, 0.0));
      std::array<double, kDirections> weights{};
      if (area <= 0) return weights;
      const double side = std::sqrt(xx);
      std::array<double, kDirections> angles{}, lengths{};
      for (std::size_t k = 0; k < kDirections; ++k) {
        const glm::dvec2 line(kDirection[k][0] * side + kDirection[k][1] * xy / side,
                              kDirection[k][1] * area / side);
        angles[k] = std::atan2(line.y, line.x);
        lengths[k] = glm::length(line);
      }
      for (std::size_t k = 0; k < kDirections; ++k) {
        const double before = k > 0 ? angles[k - 1] : angles[kDirections - 1] - std::numbers::pi;
        const double after = k + 1 < kDirections ? angles[k + 1] : angles[0] + std::numbers::pi;
        weights[k] = (after - before) / 4 * area / lengths[k];
      }
      return weights;
    }

    // Returns the sides of a texel as vectors on the surface.
    const std::pair<glm::dvec3, glm::dvec3>& sides() {
      if (sides_) return *sides_;
      const glm::dvec3 here = measuring_.place(texel_);
      const auto side = [&](Way forward, Way back) {
        const std::uint32_t next = measuring_.step(texel_, forward),
                            before = measuring_.step(texel_, back);
        const glm::dvec3 from = before != kNoNeighbour ? measuring_.place(before) : here,
                         to = next != kNoNeighbour ? measuring_.place(next) : here;
        return (to - from) / (before != kNoNeighbour && next != kNoNeighbour ? 2.0 : 1.0);
      };
      sides_.emplace(side(Way::right, Way::left), side(Way::upper, Way::lower));
      if (glm::length(glm::cross(sides_->first, sides_->second)) > 0) return *sides_;
      // In an island that is one texel wide, the texel is treated as a square.
      const double edge = std::sqrt(measuring_.map_.area[texel_]);
      sides_ = {glm::dvec3(edge, 0, 0), glm::dvec3(0, edge, 0)};
      return *sides_;
    }

    const Measuring& measuring_;
    const std::uint32_t texel_;
    std::optional<std::array<double, kDirections>> weights_;
    std::optional<Reach> reach_;
    std::optional<std::pair<glm::dvec3, glm::dvec3>> sides_;
  };

  const Classes& classes_;
  const mesh::SurfaceMap& map_;
  const mesh::TexelGraph& graph_;
  std::array<Walk, 2 * kDirections> walks_{};
};

}  // namespace

Perimeters measure_perimeters(const LayerView& view, const mesh::SurfaceMap& map,
                              const mesh::TexelGraph& graph, const TexelSelection* within,
                              const ValueClasses& value_classes, int threads) {
  const Classes classes(view, map, within, value_classes);
  const Measuring measuring(classes, map, graph);
  constexpr std::size_t kAtOnce = 1024;
  const std::size_t slots = map.block_of_slot.size();
  std::vector<Sums> parts((slots + kAtOnce - 1) / kAtOnce);
  mesh::parallel_for(threads, static_cast<int>(parts.size()), [&](int number) {
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
