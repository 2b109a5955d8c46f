#include "query/regions/selected_triangles.h"

#include <algorithm>
#include <bit>

#include "mesh/texels/surface_map.h"
#include "mesh/texels/texel_owners.h"

namespace strata::query {
namespace {

constexpr std::size_t kTexels = 64;  // of a slot

bool is_set(const TexelSelection& selected, std::size_t texel) {
  return (selected[texel / kTexels] >> (texel % kTexels) & 1) != 0;
}

// Finds the texels at texture coordinates.
class TexelLookup {
 public:
  explicit TexelLookup(const mesh::TexelOwners& owners)
      : resolution_(owners.resolution),
        blocks_per_side_(owners.blocks_per_side),
        slot_of_block_(static_cast<std::size_t>(owners.blocks_per_side) *
                           static_cast<std::size_t>(owners.blocks_per_side),
                       mesh::kNoSlot) {
    for (std::uint32_t slot = 0; slot < owners.block_of_slot.size(); ++slot)
      slot_of_block_[owners.block_of_slot[slot]] = slot;
  }

  bool is_selected(const TexelSelection& selected, const glm::vec2& uv) const {
    const auto along = [&](float coordinate) {
      return std::clamp(static_cast<int>(coordinate * static_cast<float>(resolution_)), 0,
                        resolution_ - 1);
    };
    const int x = along(uv.x), y = along(uv.y);
    const std::uint32_t slot = slot_of_block_[static_cast<std::size_t>(
        y / kBlockSize * blocks_per_side_ + x / kBlockSize)];
    if (slot == mesh::kNoSlot) return false;
    return is_set(selected, slot * kTexels + static_cast<std::size_t>(y % kBlockSize * kBlockSize +
                                                                      x % kBlockSize));
  }

 private:
  int resolution_, blocks_per_side_;
  std::vector<std::uint32_t> slot_of_block_;
};

// Adds the gutter texels of the selected texels. The center of a small triangle at the rim of a
// chart can be in one.
TexelSelection with_gutter(const mesh::TexelOwners& owners, TexelSelection selected) {
  const TexelSelection surface = selected;
  for (const auto& [texel, owner] : owners.gutter)
    if (is_set(surface, owner)) selected[texel / kTexels] |= std::uint64_t{1} << texel % kTexels;
  return selected;
}

}  // namespace

std::uint64_t bytes_to_select_triangles(const mesh::Geometry& geometry, int resolution) {
  // The owners of all texels, the lists of triangles that bake_texel_owners needs, the masks of
  // slots, and the indices of the result.
  constexpr std::uint64_t kOwner = 13, kTriangle = 40 + 13;
  return kOwner * static_cast<std::uint64_t>(resolution) * static_cast<std::uint64_t>(resolution) +
         kTriangle * geometry.triangle_count();
}

Result<std::vector<std::uint32_t>> selected_triangles(const mesh::Geometry& geometry,
                                                      int resolution,
                                                      const TexelSelection& selected,
                                                      Progress& progress) {
  const auto owners = STRATA_TRY(mesh::bake_texel_owners(geometry, resolution, progress));
  enum : std::uint8_t { kNoTexel, kOther, kSelected };
  std::vector<std::uint8_t> states(geometry.triangle_count(), kNoTexel);
  for (std::size_t slot = 0; slot < owners.surface_mask.size(); ++slot)
    for (std::uint64_t rest = owners.surface_mask[slot]; rest != 0; rest &= rest - 1) {
      const std::size_t texel = slot * kTexels + static_cast<std::size_t>(std::countr_zero(rest));
      std::uint8_t& state = states[owners.triangle[texel]];
      state = std::max<std::uint8_t>(state, is_set(selected, texel) ? kSelected : kOther);
    }
  const TexelLookup lookup(owners);
  const TexelSelection around = with_gutter(owners, selected);
  std::vector<std::uint32_t> indices;
  for (std::size_t triangle = 0; triangle < states.size(); ++triangle) {
    const std::uint32_t* corners = &geometry.indices[3 * triangle];
    const auto center = [&] {
      return (geometry.vertices[corners[0]].uv + geometry.vertices[corners[1]].uv +
              geometry.vertices[corners[2]].uv) /
             3.0f;
    };
    if (states[triangle] == kSelected ||
        (states[triangle] == kNoTexel && lookup.is_selected(around, center())))
      indices.insert(indices.end(), corners, corners + 3);
  }
  return indices;
}

}  // namespace strata::query
