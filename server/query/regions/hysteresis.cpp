#include "query/regions/hysteresis.h"

#include <bit>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/progress.h"
#include "mesh/texels/texel_graph.h"
#include "query/regions/texel_sets.h"
#include "query/regions/touching_texels.h"

namespace strata::query {
namespace {

// Calls visit(texel) for the texels whose bits are set. Returns false when cancelled.
template <class Visit>
bool for_each_set(const std::vector<std::uint64_t>& bits, Progress& progress, double from,
                  double to, Visit&& visit) {
  for (std::size_t slot = 0; slot < bits.size(); ++slot) {
    if (slot % 4096 == 0) {
      if (progress.cancelled()) return false;
      progress.report(from + (to - from) * double(slot) / double(bits.size()), "Connecting places");
    }
    for (std::uint64_t left = bits[slot]; left != 0; left &= left - 1)
      visit(
          static_cast<std::uint32_t>(slot * 64 + static_cast<std::size_t>(std::countr_zero(left))));
  }
  return true;
}

}  // namespace

Result<SurfaceValues> hysteresis_values(const SurfaceValues& values, ValueType type,
                                        const Thresholds& thresholds, const mesh::SurfaceMap& map,
                                        const mesh::TexelGraph& graph, Progress& progress) {
  const std::size_t slots = map.block_of_slot.size();
  TexelSets sets(slots * 64);
  std::vector<std::uint64_t> low(slots), high(slots);
  const auto set = [](std::vector<std::uint64_t>& bits, std::uint32_t texel) {
    bits[texel / 64] |= std::uint64_t{1} << texel % 64;
  };
  const auto has = [](const std::vector<std::uint64_t>& bits, std::uint32_t texel) {
    return (bits[texel / 64] >> texel % 64 & 1u) != 0;
  };
  const auto compare = [&](std::uint32_t texel) {
    const double value = decode_value(type, values.bits[texel]);
    if (!(value > thresholds.low)) return;
    set(low, texel);
    sets.add(texel);
    if (value > thresholds.high) set(high, texel);
  };
  const auto join = [&](std::uint32_t texel) {
    for_each_touching(map, graph, texel, [&](std::uint32_t other) {
      if (other < texel && has(low, other)) sets.join(texel, other);
    });
  };
  if (!for_each_set(values.valid, progress, 0, 0.3, compare) ||
      !for_each_set(low, progress, 0.3, 0.8, join))
    return cancelled_problem();

  // A parent is never higher than its texel, so its root is known before.
  std::vector<std::uint32_t> root = std::move(sets).take_parents();
  std::vector<std::uint64_t> reached(slots);  // by root
  SurfaceValues result{std::vector<std::uint32_t>(slots * 64), std::vector<std::uint64_t>(slots)};
  const auto find_root = [&](std::uint32_t texel) {
    root[texel] = root[root[texel]];
    if (has(high, texel)) set(reached, root[texel]);
  };
  const auto keep = [&](std::uint32_t texel) {
    if (has(reached, root[texel])) result.set(texel, {std::bit_cast<std::uint32_t>(1.0f), true});
  };
  if (!for_each_set(low, progress, 0.8, 0.9, find_root) ||
      !for_each_set(low, progress, 0.9, 1, keep))
    return cancelled_problem();
  return result;
}

}  // namespace strata::query
