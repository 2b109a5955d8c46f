#include "query/key_areas.h"

#include <stdexcept>
#include <unordered_map>

#include "query/texel_values.h"

namespace strata::query {

std::map<std::int64_t, KeyArea> key_areas(const LayerView& view, const mesh::SurfaceMap& map, double metres_per_unit) {
  if (map.resolution != view.layer.resolution)
    throw std::invalid_argument("The surface map is of another resolution than the layer.");
  std::unordered_map<std::uint32_t, KeyArea> sums;
  std::uint32_t last_bits = 0;
  KeyArea* last = nullptr;  // neighbours mostly share a key; references into the map stay
  for (const auto& [address, tile] : view.snapshot.tiles)
    for_each_value(*tile, address, view.layer.type, map, nullptr,
                   [&](std::uint32_t slot, int texel, std::uint32_t bits, double) {
                     if (!last || bits != last_bits) last = &sums[bits];
                     last_bits = bits;
                     ++last->texels;
                     last->area_m2 += map.area[std::size_t(slot) * 64 + static_cast<std::size_t>(texel)];
                   });
  std::map<std::int64_t, KeyArea> areas;
  for (const auto& [bits, sum] : sums) areas[bits] = {sum.texels, sum.area_m2 * metres_per_unit * metres_per_unit};
  return areas;
}

}  // namespace strata::query
