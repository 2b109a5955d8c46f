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

// Returns the distance of each surface texel to the nearest border, in model units. It is infinite
// for a distance above `limit`.
//
// A border is a point halfway between two connected texels. The distance is measured straight
// through space, and only along chains of connected texels within the limit, so a border on the
// other side of a thin wall does not count. On a surface with the radius of curvature R, a distance
// d along the surface is too short by about d³ / 24R². Nearest points are passed on from texel to
// texel (dead reckoning, Grevera 2004), until no distance becomes shorter.
//
// Distances of any length along the surface need another method: see the operators of distance.
// Needs 4 bytes of memory per texel of the map. Fails when cancelled.
Result<std::vector<float>> border_distances(const mesh::SurfaceMap& map,
                                            const mesh::TexelGraph& graph,
                                            const IsBorder& is_border, float limit,
                                            const Progress& progress);

}  // namespace strata::query
