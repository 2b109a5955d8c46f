#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "core/error.h"

namespace strata {
class Progress;
}
namespace strata::mesh {
struct SurfaceMap;
struct TexelGraph;
}  // namespace strata::mesh

namespace strata::query {

// Returns whether a border runs between two connected texels. Must be symmetric.
using IsBorder = std::function<bool(std::uint32_t, std::uint32_t)>;

// Returns the surface texels on both sides of each border, one word per slot: sources for
// mesh::distances_along_surface. The border is about half a texel from their centers. Needs 1 bit
// of memory per texel of the map. Fails when cancelled.
Result<std::vector<std::uint64_t>> texels_at_borders(const mesh::SurfaceMap& map,
                                                     const mesh::TexelGraph& graph,
                                                     const IsBorder& is_border,
                                                     const Progress& progress);

// Returns the texels from which the center of a texel at a border is at most `limit` (model units)
// away. Distances are straight through space, and only along chains of connected texels within the
// limit. Each texel passes on the nearest texel at a border that it knows, until no distance
// becomes shorter (dead reckoning, Grevera 2004). This is faster than distances along the surface.
// At the rim of a thin wall, the chains lead to the other side. Needs at most 24 bytes of memory
// per texel of the map. Fails when cancelled.
Result<std::vector<std::uint64_t>> texels_near_borders(const mesh::SurfaceMap& map,
                                                       const mesh::TexelGraph& graph,
                                                       const std::vector<std::uint64_t>& at_border,
                                                       float limit, const Progress& progress);

}  // namespace strata::query
