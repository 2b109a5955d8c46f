#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "mesh/texels/surface_map.h"

namespace strata::query {

// Texels that touch along an edge in the atlas and have the same label, as an area with holes.
// Corners are those of texels, in texels from the atlas's lower left; every corner on the way is
// there, also those on straight lines.
struct TexelRegion {
  std::uint32_t label = 0;
  // the outer one first, counter-clockwise; holes clockwise; not closed by a repeated corner
  std::vector<std::vector<glm::ivec2>> rings;
};

// `labels`: 64 a slot of the map; 0: none. Regions that touch at a corner alone are two. False
// where they have more than `corner_limit` corners: then `regions` holds a part of them.
bool find_regions(const mesh::SurfaceMap& map, const std::vector<std::uint32_t>& labels,
                  std::size_t corner_limit, std::vector<TexelRegion>& regions);

}  // namespace strata::query
