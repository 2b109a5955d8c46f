#include "query/regions/regions.h"

#include <bit>
#include <string>
#include <utility>

#include "mesh/texels/texel_graph.h"
#include "query/regions/texel_sets.h"
#include "query/regions/touching_texels.h"

namespace strata::query {
namespace {

constexpr std::uint32_t kSlotsAtOnce = 4096;  // between two checks whether the work is cancelled

// Joins each texel of a slot to its connected texels with the same value.
void join_slot(std::uint32_t slot, const SurfaceValues& values, const mesh::SurfaceMap& map,
               const mesh::TexelGraph& graph, Connection connection, TexelSets& sets) {
  using mesh::Way;
  for (std::uint64_t left = map.surface_mask[slot]; left != 0; left &= left - 1) {
    const auto i = static_cast<std::uint32_t>(std::countr_zero(left));
    const std::uint32_t texel = slot * 64 + i;
    const auto join = [&](std::uint32_t other) {
      if (other != mesh::kNoNeighbour && values.same(texel, other)) sets.join(texel, other);
    };
    if (connection == Connection::corners) {
      for_each_touching(map, graph, texel, [&](std::uint32_t other) {
        if (other < texel) join(other);
      });
      continue;
    }
    join(mesh::neighbour(map, graph, texel, Way::right));
    join(mesh::neighbour(map, graph, texel, Way::upper));
    if ((graph.has_links[slot] >> i & 1u) == 0) continue;
    for (const auto& [from, to] : graph.links_of(texel))
      if (to < texel) join(to);
  }
}

}  // namespace

Result<Regions> find_regions(const SurfaceValues& values, const mesh::SurfaceMap& map,
                             const mesh::TexelGraph& graph, const Progress& progress,
                             std::size_t max_regions, Connection connection) {
  const auto slots = static_cast<std::uint32_t>(map.block_of_slot.size());
  TexelSets sets(std::size_t{slots} * 64);
  const auto for_each_slot = [&](auto&& visit) {
    for (std::uint32_t slot = 0; slot < slots; ++slot) {
      if (slot % kSlotsAtOnce == 0 && progress.cancelled()) return false;
      visit(slot);
    }
    return true;
  };
  const auto add = [&](std::uint32_t slot) {
    for (std::uint64_t left = map.surface_mask[slot]; left != 0; left &= left - 1)
      sets.add(slot * 64 + static_cast<std::uint32_t>(std::countr_zero(left)));
  };
  const auto join = [&](std::uint32_t slot) {
    join_slot(slot, values, map, graph, connection, sets);
  };
  if (!for_each_slot(add) || !for_each_slot(join)) return cancelled_problem();

  Regions regions{std::move(sets).take_parents(), {}};
  std::size_t count = 0;
  const auto count_roots = [&](std::uint32_t slot) {
    for (std::uint32_t texel = slot * 64; texel < slot * 64 + 64; ++texel)
      count += regions.of_texel[texel] == texel ? 1u : 0u;
  };
  if (!for_each_slot(count_roots)) return cancelled_problem();
  if (count > max_regions)
    return fail(ErrorCode::invalid, "Too many regions",
                "The layer has " + std::to_string(count) + " regions, and at most " +
                    std::to_string(max_regions) +
                    " are allowed. Such operations need a layer of classes or records. Copy the "
                    "layer to classes with a computed layer first.",
                "layer");
  regions.list.reserve(count);
  // A parent is never higher than its texel. In ascending order, the parents of a texel already
  // have the number of their region.
  const auto number = [&](std::uint32_t slot) {
    for (std::uint64_t left = map.surface_mask[slot]; left != 0; left &= left - 1) {
      const auto i = static_cast<std::uint32_t>(std::countr_zero(left));
      const std::uint32_t texel = slot * 64 + i;
      std::uint32_t& of = regions.of_texel[texel];
      if (of == texel) {
        of = static_cast<std::uint32_t>(regions.list.size());
        regions.list.push_back({values.of(texel), false, texel, 0, 0});
      } else {
        of = regions.of_texel[of];
      }
      Region& region = regions.list[of];
      ++region.texels;
      region.area += map.area[texel];
      region.at_open_edge |= (graph.at_open_edge[slot] >> i & 1u) != 0;
    }
  };
  if (!for_each_slot(number)) return cancelled_problem();
  return regions;
}

Result<CleanedValues> recolored(SurfaceValues values, const Regions& regions,
                                const std::vector<std::optional<TexelValue>>& new_values,
                                const mesh::SurfaceMap& map, const Progress& progress) {
  CleanedValues cleaned{std::move(values), 0};
  for (const auto& value : new_values) cleaned.regions += value.has_value() ? 1u : 0u;
  const auto set = [&](std::uint32_t texel, std::uint32_t region) {
    if (const auto& value = new_values[region]) cleaned.values.set(texel, *value);
  };
  if (!for_each_texel_of_regions(regions, map, progress, set)) return cancelled_problem();
  return cleaned;
}

}  // namespace strata::query
