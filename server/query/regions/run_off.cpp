#include "query/regions/run_off.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "core/progress.h"
#include "mesh/surface/geometry.h"
#include "mesh/texels/texel_graph.h"
#include "mesh/texels/texel_owners.h"
#include "query/sampling/texel_appearance.h"

namespace strata::query {
namespace {

using mesh::kNoNeighbour;
using mesh::Way;

constexpr double kNegligible = 1e-6;  // of the rain
constexpr const char* kRunning = "Letting water run down";

// The directions in which a texel has neighbors. Links are one direction more.
enum Direction { along_rows, along_columns, across_seams, directions };

class Water {
 public:
  Water(const mesh::SurfaceMap& map, const mesh::TexelGraph& graph, glm::dvec3 up,
        std::span<const std::uint64_t> drips)
      : map_(map),
        graph_(graph),
        up_(up),
        drips_(drips),
        level_(map.block_of_slot.size() * 64, std::numeric_limits<float>::quiet_NaN()),
        next_(map.block_of_slot.size() * 64, kNoNeighbour) {}

  // Finds the level of the water at each texel and the texel to which it flows over, from the
  // outlets on. Returns false when cancelled.
  bool fill_hollows(Progress& progress) {
    order_.reserve(map_.surface_texels);
    if (progress.cancelled()) return false;
    for_each_texel([&](std::uint32_t texel) {
      if (!leaves_at(texel)) return;
      // No water reaches the middle of a ceiling, so its texels need no place in the heap.
      if (is_within_drips(texel)) {
        level_[texel] = height(texel);
        order_.push_back(texel);
      } else {
        open(texel, kNoNeighbour, height(texel));
      }
    });
    if (!flood(progress)) return false;
    // Pieces without an outlet.
    std::vector<std::pair<float, std::uint32_t>> rest;
    for_each_texel([&](std::uint32_t texel) {
      if (std::isnan(level_[texel])) rest.emplace_back(height(texel), texel);
    });
    std::ranges::sort(rest);
    for (const auto& [lowest, texel] : rest) {
      if (!std::isnan(level_[texel])) continue;
      open(texel, kNoNeighbour, lowest);
      if (!flood(progress)) return false;
    }
    heap_ = {};  // frees its memory
    return true;
  }

  Result<RunOff> run(const SurfaceValues& rain, ValueType type, const WaterFalls& falls,
                     Progress& progress) {
    RunOff result;
    const std::size_t slots = map_.block_of_slot.size();
    result.passing = {std::vector<std::uint32_t>(slots * 64), map_.surface_mask};
    std::vector<double> water(slots * 64, 0);
    for_each_texel([&](std::uint32_t texel) {
      water[texel] = rain_on(texel, rain, type);
      result.fallen += water[texel];
    });
    for (int visit = 0; visit < kMaxVisits; ++visit) {
      auto later = STRATA_TRY(visit_texels(water, falls, result, visit, progress));
      double sum = 0;
      for (const auto& [texel, amount] : later) sum += amount;
      if (visit + 1 == kMaxVisits || sum <= kNegligible * result.fallen) {
        result.pooled += sum;
        break;
      }
      for (const auto& [texel, amount] : later) water[texel] += amount;
    }
    return result;
  }

 private:
  template <class Visit>
  void for_each_texel(Visit visit) const {
    for (std::uint32_t slot = 0; slot < map_.block_of_slot.size(); ++slot)
      for (std::uint64_t left = map_.surface_mask[slot]; left != 0; left &= left - 1)
        visit(slot * 64 + static_cast<std::uint32_t>(std::countr_zero(left)));
  }
  glm::dvec3 place(std::uint32_t texel) const {
    return glm::dvec3(map_.position(texel / 64, static_cast<int>(texel % 64)));
  }
  float height(std::uint32_t texel) const {
    return static_cast<float>(glm::dot(place(texel), up_));
  }
  bool drips_at(std::uint32_t texel) const { return (drips_[texel / 64] >> texel % 64 & 1u) != 0; }
  bool leaves_at(std::uint32_t texel) const {
    return drips_at(texel) || (graph_.at_open_edge[texel / 64] >> texel % 64 & 1u) != 0;
  }
  bool is_within_drips(std::uint32_t texel) const {
    bool within = drips_at(texel);
    mesh::for_each_neighbour(map_, graph_, texel,
                             [&](std::uint32_t other) { within &= drips_at(other); });
    return within;
  }
  double rain_on(std::uint32_t texel, const SurfaceValues& rain, ValueType type) const {
    const TexelValue value = rain.of(texel);
    if (!value.valid) return 0;
    const double amount = decode_value(type, value.bits);
    return std::isfinite(amount) && amount > 0 ? amount * double{map_.area[texel]} : 0;
  }

  void open(std::uint32_t texel, std::uint32_t next, float level) {
    level_[texel] = level;
    next_[texel] = next;
    heap_.emplace_back(level, texel);
    std::ranges::push_heap(heap_, std::greater{});
  }

  bool flood(Progress& progress) {
    while (!heap_.empty()) {
      const auto [level, texel] = heap_.front();
      std::ranges::pop_heap(heap_, std::greater{});
      heap_.pop_back();
      if (order_.size() % (1 << 16) == 0) {
        if (progress.cancelled()) return false;
        progress.report(0.7 * double(order_.size()) / double(map_.surface_texels), kRunning);
      }
      order_.push_back(texel);
      mesh::for_each_neighbour(map_, graph_, texel, [&, at = level, from = texel](auto other) {
        if (std::isnan(level_[other])) open(other, from, std::max(at, height(other)));
      });
    }
    return true;
  }

  // Lets the water of each texel run down, from high to low. Visits are counted from 0. Returns the
  // water that landed on texels that had been visited before.
  using Landed = std::vector<std::pair<std::uint32_t, double>>;
  Result<Landed> visit_texels(std::vector<double>& water, const WaterFalls& falls, RunOff& result,
                              int visit, Progress& progress) {
    Landed later;
    std::vector<std::uint64_t> visited(map_.block_of_slot.size(), 0);
    const auto fall = [&](std::uint32_t to, double amount, double& leaving) {
      if (to == kNoNeighbour) {
        leaving += amount;
        return;
      }
      result.landed += amount;
      if ((visited[to / 64] >> to % 64 & 1u) != 0)
        later.emplace_back(to, amount);
      else
        water[to] += amount;
    };
    for (std::size_t left = order_.size(); left-- > 0;) {
      if (left % (1 << 18) == 0) {
        if (progress.cancelled()) return cancelled_problem();
        const double part = 1 - double(left) / double(order_.size());
        progress.report(0.7 + 0.3 * (visit + part) / kMaxVisits, kRunning);
      }
      const std::uint32_t texel = order_[left];
      visited[texel / 64] |= std::uint64_t{1} << texel % 64;
      const double passing = std::exchange(water[texel], 0);
      if (!(passing > 0)) continue;
      double across = std::sqrt(double{map_.area[texel]});  // the length across the water's way
      if (drips_at(texel)) {
        fall(falls.below(texel), passing, result.dripped);
      } else if (!outflows_of(texel)) {
        if (next_[texel] != kNoNeighbour)
          water[next_[texel]] += passing;
        else if (leaves_at(texel))
          fall(falls.below_edge(texel), passing, result.over_edges);
        else
          result.pooled += passing;
      } else {
        for (const Outflow& each : outflows_) water[each.to] += passing * each.share;
        across = across_;
      }
      std::uint32_t& bits = result.passing.bits[texel];
      const double before = double{std::bit_cast<float>(bits)};
      bits = std::bit_cast<std::uint32_t>(
          static_cast<float>(before + (across > 0 ? passing / across : 0)));
    }
    return later;
  }

  struct Outflow {
    std::uint32_t to;
    double share;
  };

  // Finds the lower neighbors of a texel, and the length across the way of the water. Returns false
  // without a lower neighbor: in a hollow, and at an outlet.
  bool outflows_of(std::uint32_t texel) {
    outflows_.clear();
    const auto sides = sides_of(texel);
    std::array<double, directions> slopes{};
    double sum = 0;
    const glm::dvec3 from = place(texel);
    const auto flow = [&](std::uint32_t to, Direction direction, double share) {
      if (to == kNoNeighbour || !(level_[to] < level_[texel])) return;
      const double distance = glm::distance(from, place(to));
      if (!(distance > 0)) return;
      const double slope = (double{level_[texel]} - double{level_[to]}) / distance;
      const double weight = share * slope * sides[direction];
      if (!(weight > 0)) return;
      slopes[direction] = std::max(slopes[direction], slope);
      outflows_.push_back({to, weight});
      sum += weight;
    };
    for (const Way way : {Way::right, Way::left})
      flow(mesh::neighbour(map_, graph_, texel, way), along_rows, 1);
    for (const Way way : {Way::upper, Way::lower})
      flow(mesh::neighbour(map_, graph_, texel, way), along_columns, 1);
    if ((graph_.has_links[texel / 64] >> texel % 64 & 1u) != 0) {
      const auto links = graph_.links_of(texel);
      for (const auto& [here, to] : links) flow(to, across_seams, 1 / double(links.size()));
    }
    if (outflows_.empty()) return false;
    for (Outflow& each : outflows_) each.share /= sum;
    double across = 0, squares = 0;
    for (int i = 0; i < directions; ++i) {
      across += slopes[i] * sides[i];
      squares += slopes[i] * slopes[i];
    }
    across_ = across / std::sqrt(squares);
    return true;
  }

  // Returns the length of the side of a texel through which water flows in each direction. Between
  // neighbors, because the area of single texels is uneven along the edges of the mesh.
  std::array<double, directions> sides_of(std::uint32_t texel) const {
    const double side = std::sqrt(double{map_.area[texel]});
    const glm::dvec3 from = place(texel);
    const auto length = [&](Way one, Way other) {
      double sum = 0;
      int count = 0;
      for (const Way way : {one, other})
        if (const std::uint32_t to = mesh::neighbour(map_, graph_, texel, way);
            to != kNoNeighbour) {
          sum += glm::distance(from, place(to));
          ++count;
        }
      return count > 0 ? sum / count : side;
    };
    return {length(Way::upper, Way::lower), length(Way::right, Way::left), side};
  }

  const mesh::SurfaceMap& map_;
  const mesh::TexelGraph& graph_;
  const glm::dvec3 up_;
  const std::span<const std::uint64_t> drips_;
  std::vector<float> level_;         // of the water in hollows, otherwise of the surface
  std::vector<std::uint32_t> next_;  // from which texel the flood came; kNoNeighbour: an outlet
  std::vector<std::uint32_t> order_;
  std::vector<std::pair<float, std::uint32_t>> heap_;
  std::vector<Outflow> outflows_;  // of the last call of outflows_of
  double across_ = 0;
};

}  // namespace

Result<std::vector<std::uint64_t>> dripping_texels(
    const std::shared_ptr<const mesh::Geometry>& geometry, const mesh::SurfaceMap& map,
    glm::dvec3 up, Progress& progress, int threads) {
  const auto owners = STRATA_TRY(mesh::bake_texel_owners(*geometry, map.resolution, progress));
  const auto normals = STRATA_TRY(normals_of_texels(geometry, owners, progress, threads));
  const double lowest = -std::sin(kDripAngle * std::numbers::pi / 180);
  std::vector<std::uint64_t> drips(map.block_of_slot.size(), 0);
  for (std::uint32_t slot = 0; slot < drips.size(); ++slot)
    for (std::uint64_t left = map.surface_mask[slot]; left != 0; left &= left - 1) {
      const auto i = static_cast<std::uint32_t>(std::countr_zero(left));
      const std::uint32_t normal = normals[slot * 64 + i];
      if (normal != kNoNormal && glm::dot(glm::dvec3(unpacked_normal(normal)), up) < lowest)
        drips[slot] |= std::uint64_t{1} << i;
    }
  return drips;
}

Result<RunOff> run_off(const SurfaceValues& rain, ValueType type, glm::dvec3 up,
                       std::span<const std::uint64_t> drips, const WaterFalls& falls,
                       const mesh::SurfaceMap& map, const mesh::TexelGraph& graph,
                       Progress& progress) {
  Water water(map, graph, up, drips);
  if (!water.fill_hollows(progress)) return cancelled_problem();
  return water.run(rain, type, falls, progress);
}

}  // namespace strata::query
