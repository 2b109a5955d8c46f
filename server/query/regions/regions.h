#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/error.h"
#include "core/progress.h"
#include "query/regions/surface_values.h"

namespace strata::mesh {
struct TexelGraph;
}

namespace strata::query {

// More regions than any painting by hand has.
inline constexpr std::size_t kMaxRegions = 1'000'000;
// The largest memory per region for the list of the regions and for the operations on it.
inline constexpr std::size_t kBytesPerRegion = 200;
inline constexpr std::uint32_t kNoRegion = 0xffffffffu;

// Connected texels of one value, or connected texels without a value. Seams of the atlas do not
// separate regions.
struct Region {
  TexelValue value;
  bool at_open_edge = false;  // contains a texel at which the mesh ends
  std::uint32_t first_texel = 0;
  std::uint64_t texels = 0;
  double area = 0;  // model units²
};

// Which texels are connected to each other.
enum class Connection {
  sides,
  corners,  // also those that touch only at a corner (touching_texels.h)
};

struct Regions {
  std::vector<std::uint32_t> of_texel;  // kNoRegion for a texel that is not on the surface
  std::vector<Region> list;             // ascending by `first_texel`
};

// Returns the regions of the whole surface. Needs 4 bytes of memory per texel of the map, and
// kBytesPerRegion. Fails when cancelled, and with an `invalid` error at `layer` for more than
// `max_regions` regions.
Result<Regions> find_regions(const SurfaceValues& values, const mesh::SurfaceMap& map,
                             const mesh::TexelGraph& graph, const Progress& progress,
                             std::size_t max_regions = kMaxRegions,
                             Connection connection = Connection::sides);

// The result of an operation on the regions of a layer.
struct CleanedValues {
  SurfaceValues values;
  std::uint64_t regions = 0;  // regions that got another value
};

// Sets the new value of each region that has one. Fails when cancelled.
Result<CleanedValues> recolored(SurfaceValues values, const Regions& regions,
                                const std::vector<std::optional<TexelValue>>& new_values,
                                const mesh::SurfaceMap& map, const Progress& progress);

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

}  // namespace strata::query
