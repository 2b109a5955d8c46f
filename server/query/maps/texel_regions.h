#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "mesh/texels/surface_map.h"

namespace strata::query {

// Texels that touch along an edge in the atlas and have the same label, as an area with holes.
// Corners are corners of texels, in texels from the atlas's lower left; the rings contain every
// corner, also those on straight lines.
struct TexelRegion {
  std::uint32_t label = 0;
  // the outer one first, counterclockwise; holes clockwise; not closed by a repeated corner
  std::vector<std::vector<glm::ivec2>> rings;
};

// `labels`: 64 a slot of the map; 0: no label. Regions that touch only at a corner are separate.
// Returns false if there are more than `corner_limit` corners: then `regions` is incomplete.
bool find_regions(const mesh::SurfaceMap& map, const std::vector<std::uint32_t>& labels,
                  std::size_t corner_limit, std::vector<TexelRegion>& regions);

}  // namespace strata::query
