#include "query/regions/watershed.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/progress.h"
#include "mesh/texels/texel_graph.h"

namespace strata::query {
namespace {

using mesh::kNoNeighbour;

// Bits that are ordered like the numbers.
std::uint32_t ordered(float number) {
  const auto bits = std::bit_cast<std::uint32_t>(number);
  return (bits >> 31) != 0 ? ~bits : bits | 0x80000000u;
}

// The basins while the surface is flooded: a tree of texels for each, with its lowest texel as the
// root.
class Basins {
 public:
  explicit Basins(std::size_t texels) : parent_(texels, kNoNeighbour) {}

  bool is_flooded(std::uint32_t texel) const { return parent_[texel] != kNoNeighbour; }
  void begin(std::uint32_t texel) { parent_[texel] = texel; }
  void add(std::uint32_t texel, std::uint32_t to) { parent_[texel] = to; }
  std::uint32_t root_of(std::uint32_t texel) {
    std::uint32_t root = texel;
    while (parent_[root] != root) root = parent_[root];
    while (parent_[texel] != root) texel = std::exchange(parent_[texel], root);
    return root;
  }

 private:
  std::vector<std::uint32_t> parent_;
};

struct Flood {
  std::vector<float> numbers;
  // Ascending by number and then by texel: ordered(number) << 32 | texel.
  std::vector<std::uint64_t> order;
};

Flood begin_flood(const SurfaceValues& values, ValueType type) {
  Flood flood;
  flood.numbers.resize(values.bits.size());
  for (std::uint32_t texel = 0; texel < values.bits.size(); ++texel) {
    const TexelValue value = values.of(texel);
    if (!value.valid) continue;
    const auto number = static_cast<float>(decode_value(type, value.bits));
    if (!std::isfinite(number)) continue;
    flood.numbers[texel] = number;
    flood.order.push_back(std::uint64_t{ordered(number)} << 32 | texel);
  }
  std::ranges::sort(flood.order);
  return flood;
}

// Numbers the basins by area, the largest first, then by the lowest texel.
Result<SurfaceValues> number_basins(const Flood& flood, Basins& basins, const mesh::SurfaceMap& map,
                                    const std::string& field) {
  std::vector<double> area(flood.numbers.size(), 0);
  std::vector<std::uint32_t> roots;
  for (const std::uint64_t each : flood.order) {
    const auto texel = static_cast<std::uint32_t>(each);
    const std::uint32_t root = basins.root_of(texel);
    if (root == texel) roots.push_back(root);
    area[root] += double{map.area[texel]};
  }
  if (roots.size() > kMaxBasins)
    return fail(
        ErrorCode::invalid, "Too many basins",
        "There are more than 1 000 000 basins. Choose a larger height, or smooth the values "
        "first (focal_mean).",
        field);
  std::ranges::sort(roots, [&](std::uint32_t a, std::uint32_t b) {
    return area[a] != area[b] ? area[a] > area[b] : a < b;
  });
  const std::size_t slots = map.block_of_slot.size();
  SurfaceValues numbered{std::vector<std::uint32_t>(slots * 64), std::vector<std::uint64_t>(slots)};
  for (std::size_t i = 0; i < roots.size(); ++i)
    numbered.bits[roots[i]] = std::bit_cast<std::uint32_t>(static_cast<float>(i + 1));
  for (const std::uint64_t each : flood.order) {
    const auto texel = static_cast<std::uint32_t>(each);
    numbered.set(texel, {numbered.bits[basins.root_of(texel)], true});
  }
  return numbered;
}

}  // namespace

Result<SurfaceValues> watershed_values(const SurfaceValues& values, ValueType type, double height,
                                       const mesh::SurfaceMap& map, const mesh::TexelGraph& graph,
                                       const std::string& field, Progress& progress) {
  constexpr const char* kFlooding = "Flooding basins";
  progress.report(0, kFlooding);
  const Flood flood = begin_flood(values, type);
  const auto depth_of = [&](std::uint32_t root, float at) {
    return double{at} - double{flood.numbers[root]};
  };
  Basins basins(values.bits.size());
  std::size_t done = 0;
  for (const std::uint64_t each : flood.order) {
    if (done++ % (1 << 18) == 0) {
      if (progress.cancelled()) return cancelled_problem();
      progress.report(0.3 + 0.6 * double(done) / double(flood.order.size()), kFlooding);
    }
    const auto texel = static_cast<std::uint32_t>(each);
    const float number = flood.numbers[texel];
    std::uint32_t lowest = kNoNeighbour;
    mesh::for_each_neighbour(map, graph, texel, [&](std::uint32_t other) {
      if (!basins.is_flooded(other)) return;
      if (lowest == kNoNeighbour ||
          std::pair(flood.numbers[other], other) < std::pair(flood.numbers[lowest], lowest))
        lowest = other;
    });
    if (lowest == kNoNeighbour) {
      basins.begin(texel);
      continue;
    }
    basins.add(texel, basins.root_of(lowest));
    mesh::for_each_neighbour(map, graph, texel, [&](std::uint32_t other) {
      if (!basins.is_flooded(other)) return;
      const std::uint32_t here = basins.root_of(texel), there = basins.root_of(other);
      if (here == there) return;
      const bool here_is_deeper =
          std::pair(flood.numbers[here], here) < std::pair(flood.numbers[there], there);
      const std::uint32_t shallow = here_is_deeper ? there : here;
      const double depth = depth_of(shallow, number);
      if (depth < height || depth == 0) basins.add(shallow, here_is_deeper ? here : there);
    });
  }
  progress.report(0.9, kFlooding);
  return number_basins(flood, basins, map, field);
}

}  // namespace strata::query
