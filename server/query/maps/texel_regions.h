#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "mesh/texels/surface_map.h"

namespace strata::query {

// Texels with the same label that touch along edges in the atlas, as an area with holes. The
// corners of rings are corners of texels, in texels from the lower left corner of the atlas. Rings
// contain every corner, also those on straight lines.
struct TexelRegion {
  std::uint32_t label = 0;
  // the outer ring first, counterclockwise; holes clockwise; the first corner is not repeated
  std::vector<std::vector<glm::ivec2>> rings;
};

// `labels` has 64 labels for each slot of the map; 0 means no label. Regions that touch only at a
// corner are separate. If there are more than `corner_limit` corners, returns false and `regions`
// is incomplete.
bool find_regions(const mesh::SurfaceMap& map, const std::vector<std::uint32_t>& labels,
                  std::size_t corner_limit, std::vector<TexelRegion>& regions);

}  // namespace strata::query
