#pragma once

#include <bit>
#include <optional>
#include <utility>
#include <vector>

#include "core/progress.h"
#include "query/regions/sieve.h"

namespace strata::query {

// Calls visit(texel, region) for each surface texel. Returns false when cancelled.
template <class Visit>
bool for_each_texel_of_regions(const Regions& regions, const mesh::SurfaceMap& map,
                               const Progress& progress, Visit&& visit) {
  for (std::uint32_t slot = 0; slot < map.block_of_slot.size(); ++slot) {
    if (slot % 4096 == 0 && progress.cancelled()) return false;
    for (std::uint64_t left = map.surface_mask[slot]; left != 0; left &= left - 1) {
      const std::uint32_t texel = slot * 64 + static_cast<std::uint32_t>(std::countr_zero(left));
      visit(texel, regions.of_texel[texel]);
    }
  }
  return true;
}

// Sets the new value of each region that has one. Fails when cancelled.
inline Result<CleanedValues> recolored(SurfaceValues values, const Regions& regions,
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
