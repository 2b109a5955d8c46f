#include "mesh/texels/surface_map.h"

#include <bit>

#include "mesh/texels/packed_position.h"
#include "mesh/texels/slot_bits.h"

namespace strata::mesh {
glm::vec3 SurfaceMap::position(std::uint32_t slot, int texel) const {
  return unpack_position(packed_position[std::size_t{slot} * 64 + texel], packed_box[slot]);
}

TileMask SurfaceMap::owned_in_tile(TileAddress tile) const {
  return gather_tile_bits(*this, tile, [&](std::uint32_t slot) {
    std::uint64_t bits = 0;
    for (int i = 0; i < 64; ++i)
      bits |= std::uint64_t{packed_position[std::size_t{slot} * 64 + i] != kNoPosition} << i;
    return bits;
  });
}

TileMask SurfaceMap::surface_in_tile(TileAddress tile) const {
  return gather_tile_bits(*this, tile, [&](std::uint32_t slot) { return surface_mask[slot]; });
}

std::uint64_t SurfaceMap::texels_of_parts(std::uint32_t slot, const PartSet& parts) const {
  if (part.empty()) return 0;
  std::uint64_t texels = 0;
  for (std::size_t i = 0; i < 64; ++i)
    texels |= std::uint64_t{parts.test(part[std::size_t{slot} * 64 + i])} << i;
  return texels;
}

float SurfaceMap::area_of(TileAddress tile, int texel) const {
  const SlotTexel place = slot_texel(*this, tile, texel);
  return place.slot == kNoSlot ? 0 : area[std::size_t{place.slot} * 64 + place.texel];
}

void SurfaceMap::add_texel(SlotSums& sums, std::uint32_t slot, int texel) const {
  const double texel_area = area[std::size_t{slot} * 64 + static_cast<std::size_t>(texel)];
  const glm::vec3 at = position(slot, texel);
  ++sums.texels;
  sums.area += texel_area;
  sums.weighted_position += texel_area * glm::dvec3(at);
  sums.lowest = glm::min(sums.lowest, at);
  sums.highest = glm::max(sums.highest, at);
}

SurfaceMap::SlotSums SurfaceMap::sum_slot(std::uint32_t slot) const {
  SlotSums sums;
  for (std::uint64_t rest = surface_mask[slot]; rest != 0; rest &= rest - 1)
    add_texel(sums, slot, std::countr_zero(rest));
  return sums;
}

std::size_t SurfaceMap::bytes() const {
  const auto of = [](const auto& v) { return v.capacity() * sizeof(v[0]); };
  return of(slot_of_block) + of(block_of_slot) + of(packed_position) + of(packed_box) +
         of(surface_mask) + of(area) + of(sums_of_slot) + of(bounds_of_slot) + of(bounds_of_tile) +
         of(part) + tree.bytes();
}

}  // namespace strata::mesh
