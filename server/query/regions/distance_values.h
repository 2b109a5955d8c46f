#pragma once

#include "core/error.h"
#include "query/conditions/texel_selection.h"
#include "query/regions/surface_values.h"

namespace strata {
class Progress;
}
namespace strata::mesh {
struct TexelGraph;
}

namespace strata::query {

// Values from distances along the surface (mesh/distance/surface_distance.h), in model units, up to
// `limit`; infinity: no limit. Texels that are not reached have no value. Both functions need about
// 16 bytes of memory per texel of the map, and 2 KiB per texel at a seam. The result does not
// depend on the number of threads. They fail when cancelled, and with `malformed` if the limit is
// negative or not a number.

// Returns the distance of each surface texel from the nearest texel in `sources`, as f32.
Result<SurfaceValues> distance_values(const TexelSelection& sources, double limit,
                                      const mesh::SurfaceMap& map, const mesh::TexelGraph& graph,
                                      Progress& progress, int threads = 1);

// Gives each surface texel the value of the nearest texel with a value. If several are almost
// equally near, takes one of them, so borders between the regions of values are exact to about two
// texels.
Result<SurfaceValues> nearest_values(const SurfaceValues& values, double limit,
                                     const mesh::SurfaceMap& map, const mesh::TexelGraph& graph,
                                     Progress& progress, int threads = 1);

}  // namespace strata::query
