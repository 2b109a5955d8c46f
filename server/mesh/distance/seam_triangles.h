#pragma once

#include <cstdint>
#include <vector>

#include "mesh/texels/texel_graph.h"

namespace strata::mesh {

// A triangle of a texel with two texels around it, at least one of which is beyond a seam. It is
// measured on the surface, because the charts of a seam differ in scale and direction.
struct SeamTriangle {
  std::uint32_t texel, a;
  std::uint32_t b;           // kNoNeighbour: only the side to `a`
  float to_a, to_b, a_to_b;  // in model units
};

// Returns the triangles around the surface texels of a slot from which a link is at most two steps
// away, without the texels whose eight neighbors in the atlas are all connected. A texel that
// coincides with another one has only sides.
std::vector<SeamTriangle> seam_triangles(const SurfaceMap& map, const TexelGraph& graph,
                                         std::uint32_t slot);

}  // namespace strata::mesh
