#include "query/texel_selection.h"

#include <bit>

namespace strata::query {

SelectionExtent measure_selection(const mesh::SurfaceMap& map, const TexelSelection* selection) {
  SelectionExtent extent;
  for (std::uint32_t slot = 0; slot < map.surface_mask.size(); ++slot) {
    std::uint64_t rest = map.surface_mask[slot];
    if (selection) rest &= (*selection)[slot];
    for (; rest != 0; rest &= rest - 1) {
      const int texel = std::countr_zero(rest);
      const glm::vec3 position = map.position(slot, texel);
      extent.low = extent.texels == 0 ? position : glm::min(extent.low, position);
      extent.high = extent.texels == 0 ? position : glm::max(extent.high, position);
      ++extent.texels;
      extent.area += map.area[std::size_t{slot} * 64 + static_cast<std::size_t>(texel)];
    }
  }
  return extent;
}

}  // namespace strata::query
