#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/error.h"
#include "query/regions/surface_values.h"

namespace strata {
class Progress;
}
namespace strata::mesh {
struct TexelGraph;
}

namespace strata::query {

// More regions than any painting by hand has. The list of so many regions needs about 200 MB.
inline constexpr std::size_t kMaxRegions = 1'000'000;
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

struct Regions {
  std::vector<std::uint32_t> of_texel;  // kNoRegion for a texel that is not on the surface
  std::vector<Region> list;             // ascending by `first_texel`
};

// Returns the regions of the whole surface. Needs 4 bytes of memory per texel of the map. Fails
// when cancelled, and with an `invalid` error at `layer` for more than kMaxRegions regions.
Result<Regions> find_regions(const SurfaceValues& values, const mesh::SurfaceMap& map,
                             const mesh::TexelGraph& graph, const Progress& progress);

}  // namespace strata::query
