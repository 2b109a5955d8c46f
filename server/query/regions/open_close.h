#pragma once

#include <cstdint>

#include "core/error.h"
#include "query/regions/surface_values.h"

namespace strata {
class Progress;
}
namespace strata::mesh {
struct TexelGraph;
}

namespace strata::query {

// Morphological opening and closing of the texels with one value, with a disc of `radius` (model
// units). They dilate and erode as in dilate_erode.h. A width may be wrong by a texel, and by the
// error of the distances.

// Removes the parts of the set that are narrower than twice the radius: erodes, then dilates. A
// texel that is removed gets the value, or no value, of the nearest texel outside the set. All
// functions fail when cancelled.
Result<SurfaceValues> open_value(SurfaceValues values, std::uint32_t value, double radius,
                                 const mesh::SurfaceMap& map, const mesh::TexelGraph& graph,
                                 Progress& progress, int threads = 1);

// Closes the gaps that are narrower than twice the radius: dilates, then erodes. The texels of a
// gap get the value instead of their own. A gap between the set and the edge of the mesh is
// closed if it is narrower than the radius.
Result<SurfaceValues> close_value(SurfaceValues values, std::uint32_t value, double radius,
                                  const mesh::SurfaceMap& map, const mesh::TexelGraph& graph,
                                  Progress& progress, int threads = 1);

}  // namespace strata::query
