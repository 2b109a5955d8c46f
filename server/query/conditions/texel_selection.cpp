#include "query/conditions/texel_selection.h"

#include <algorithm>
#include <bit>

#include "core/compensated_sum.h"
#include "mesh/parallel.h"
#include "mesh/texels/surface_map.h"

namespace strata::query {
namespace {

constexpr std::size_t kSlotsAtOnce = 4096;

SelectionExtent measure_slots(const mesh::SurfaceMap& map, const TexelSelection* selection,
                              std::size_t first, std::size_t last) {
  SelectionExtent extent;
  CompensatedSum area;
  for (std::size_t slot = first; slot < last; ++slot) {
    std::uint64_t rest = map.surface_mask[slot];
    if (selection) rest &= (*selection)[slot];
    for (; rest != 0; rest &= rest - 1) {
      const int texel = std::countr_zero(rest);
      const glm::vec3 position = map.position(static_cast<std::uint32_t>(slot), texel);
      extent.low = extent.texels == 0 ? position : glm::min(extent.low, position);
      extent.high = extent.texels == 0 ? position : glm::max(extent.high, position);
      ++extent.texels;
      area += map.area[slot * 64 + static_cast<std::size_t>(texel)];
    }
  }
  extent.area = area.value();
  return extent;
}

}  // namespace

SelectionExtent measure_selection(const mesh::SurfaceMap& map, const TexelSelection* selection,
                                  int threads) {
  const std::size_t slots = map.surface_mask.size();
  std::vector<SelectionExtent> parts((slots + kSlotsAtOnce - 1) / kSlotsAtOnce);
  mesh::parallel_for(threads, static_cast<int>(parts.size()), [&](int number) {
    const std::size_t first = static_cast<std::size_t>(number) * kSlotsAtOnce;
    parts[static_cast<std::size_t>(number)] =
        measure_slots(map, selection, first, std::min(slots, first + kSlotsAtOnce));
  });
  SelectionExtent all;
  CompensatedSum area;
  for (const SelectionExtent& part : parts) {
    if (part.texels == 0) continue;
    all.low = all.texels == 0 ? part.low : glm::min(all.low, part.low);
    all.high = all.texels == 0 ? part.high : glm::max(all.high, part.high);
    all.texels += part.texels;
    area += part.area;
  }
  all.area = area.value();
  return all;
}

}  // namespace strata::query
