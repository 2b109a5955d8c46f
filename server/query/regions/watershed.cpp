#include "query/regions/watershed.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "core/progress.h"
#include "mesh/texels/texel_graph.h"
#include "query/regions/texel_sets.h"

namespace strata::query {
namespace {

using mesh::kNoNeighbour;

constexpr const char* kFlooding = "Flooding basins";

// Bits that are ordered like the numbers.
std::uint32_t ordered(float number) {
  const auto bits = std::bit_cast<std::uint32_t>(number);
  return (bits >> 31) != 0 ? ~bits : bits | 0x80000000u;
}

struct Flood {
  std::vector<float> numbers;
  // Ascending by number and then by texel: ordered(number) << 32 | texel.
  std::vector<std::uint64_t> order;
};

// Checks for cancellation every this many texels.
constexpr std::size_t kTexelsAtOnce = 1 << 18;

// Sorts by counting the upper half of each number, and then within those of equal upper halves.
Result<Flood> begin_flood(const SurfaceValues& values, ValueType type, Progress& progress) {
  Flood flood;
  flood.numbers.assign(values.bits.size(), std::numeric_limits<float>::quiet_NaN());
  std::vector<std::size_t> first(65'537, 0);
  for (std::uint32_t texel = 0; texel < values.bits.size(); ++texel) {
    if (texel % kTexelsAtOnce == 0 && progress.cancelled()) return cancelled_problem();
    const TexelValue value = values.of(texel);
    if (!value.valid) continue;
    const auto number = static_cast<float>(decode_value(type, value.bits));
    if (!std::isfinite(number)) continue;
    flood.numbers[texel] = number;
    ++first[(ordered(number) >> 16) + 1];
  }
  std::partial_sum(first.begin(), first.end(), first.begin());
  flood.order.resize(first.back());
  std::vector<std::size_t> next(first.begin(), first.end() - 1);
  for (std::uint32_t texel = 0; texel < flood.numbers.size(); ++texel) {
    if (texel % kTexelsAtOnce == 0 && progress.cancelled()) return cancelled_problem();
    if (std::isnan(flood.numbers[texel])) continue;
    const std::uint32_t bits = ordered(flood.numbers[texel]);
    flood.order[next[bits >> 16]++] = std::uint64_t{bits} << 32 | texel;
  }
  for (std::size_t part = 0; part + 1 < first.size(); ++part) {
    if (first[part] == first[part + 1]) continue;
    if (progress.cancelled()) return cancelled_problem();
    std::sort(flood.order.begin() + static_cast<std::ptrdiff_t>(first[part]),
              flood.order.begin() + static_cast<std::ptrdiff_t>(first[part + 1]));
    progress.report(0.3 * double(first[part + 1]) / double(flood.order.size()), kFlooding);
  }
  return flood;
}

tl::unexpected<Error> too_many_basins(std::size_t max_basins, const std::string& field) {
  return fail(ErrorCode::invalid, "Too many basins",
              "There are more than " + std::to_string(max_basins) +
                  " basins. Choose a larger height, or smooth the values first (focal_mean).",
              field);
}

// Numbers the basins by area, the largest first, then by the lowest texel.
Result<SurfaceValues> number_basins(const Flood& flood, TexelSets& basins,
                                    const mesh::SurfaceMap& map, std::size_t max_basins,
                                    const std::string& field, Progress& progress) {
  const std::size_t slots = map.block_of_slot.size();
  SurfaceValues result{std::vector<std::uint32_t>(slots * 64), std::vector<std::uint64_t>(slots)};
  std::vector<std::uint32_t> roots;
  const auto for_each_texel = [&](double from, auto visit) {
    for (std::size_t i = 0; i < flood.order.size(); ++i) {
      if (i % kTexelsAtOnce == 0) {
        if (progress.cancelled()) return false;
        progress.report(from + 0.05 * double(i) / double(flood.order.size()), kFlooding);
      }
      visit(static_cast<std::uint32_t>(flood.order[i]));
    }
    return true;
  };
  // The index of each basin is at its root, until its number is known.
  if (!for_each_texel(0.85, [&](std::uint32_t texel) {
        if (basins.root(texel) != texel || roots.size() > max_basins) return;
        result.bits[texel] = static_cast<std::uint32_t>(roots.size());
        roots.push_back(texel);
      }))
    return cancelled_problem();
  if (roots.size() > max_basins) return too_many_basins(max_basins, field);
  std::vector<double> area(roots.size(), 0);
  if (!for_each_texel(0.9, [&](std::uint32_t texel) {
        area[result.bits[basins.root(texel)]] += double{map.area[texel]};
      }))
    return cancelled_problem();
  std::vector<std::uint32_t> by_area(roots.size()), number(roots.size());
  std::iota(by_area.begin(), by_area.end(), 0u);
  std::ranges::sort(by_area, [&](std::uint32_t a, std::uint32_t b) {
    return area[a] != area[b] ? area[a] > area[b] : roots[a] < roots[b];
  });
  for (std::uint32_t i = 0; i < by_area.size(); ++i)
    number[by_area[i]] = std::bit_cast<std::uint32_t>(static_cast<float>(i + 1));
  if (!for_each_texel(0.95, [&](std::uint32_t texel) {
        const std::uint32_t root = basins.root(texel);
        if (root != texel) result.set(texel, {number[result.bits[root]], true});
      }))
    return cancelled_problem();
  for (std::size_t i = 0; i < roots.size(); ++i) result.set(roots[i], {number[i], true});
  return result;
}

}  // namespace

Result<SurfaceValues> watershed_values(const SurfaceValues& values, ValueType type, double height,
                                       const mesh::SurfaceMap& map, const mesh::TexelGraph& graph,
                                       const std::string& field, Progress& progress,
                                       std::size_t max_basins) {
  progress.report(0, kFlooding);
  const Flood flood = STRATA_TRY(begin_flood(values, type, progress));
  const auto depth_of = [&](std::uint32_t root, float at) {
    return double{at} - double{flood.numbers[root]};
  };
  TexelSets basins(values.bits.size());  // their roots are their lowest places
  std::size_t done = 0;
  for (const std::uint64_t each : flood.order) {
    if (done++ % kTexelsAtOnce == 0) {
      if (progress.cancelled()) return cancelled_problem();
      progress.report(0.3 + 0.55 * double(done) / double(flood.order.size()), kFlooding);
    }
    const auto texel = static_cast<std::uint32_t>(each);
    const float number = flood.numbers[texel];
    std::uint32_t lowest = kNoNeighbour;
    mesh::for_each_neighbour(map, graph, texel, [&](std::uint32_t other) {
      if (!basins.has(other)) return;
      if (lowest == kNoNeighbour ||
          std::pair(flood.numbers[other], other) < std::pair(flood.numbers[lowest], lowest))
        lowest = other;
    });
    if (lowest == kNoNeighbour) {
      basins.add(texel);
      continue;
    }
    basins.attach(texel, basins.root(lowest));
    mesh::for_each_neighbour(map, graph, texel, [&](std::uint32_t other) {
      if (!basins.has(other)) return;
      const std::uint32_t here = basins.root(texel), there = basins.root(other);
      if (here == there) return;
      const bool here_is_deeper =
          std::pair(flood.numbers[here], here) < std::pair(flood.numbers[there], there);
      const std::uint32_t shallow = here_is_deeper ? there : here;
      const double depth = depth_of(shallow, number);
      if (depth < height || depth == 0) basins.attach(shallow, here_is_deeper ? here : there);
    });
  }
  return number_basins(flood, basins, map, max_basins, field, progress);
}

}  // namespace strata::query
