#pragma once

#include "core/error.h"
#include "query/regions/surface_values.h"

namespace strata {
class Progress;
}
namespace strata::mesh {
struct TexelGraph;
}

namespace strata::query {

// The largest radius of `majority`, in model units: 40 texels of the mean size. Bounds the time per
// texel.
double max_majority_radius(const mesh::SurfaceMap& map);

// Gives each surface texel the value with the largest area within `radius` (model units) around it.
// "No value" counts like a value. The own value of the texel wins against areas that are larger by
// less than 1 in 10⁴. Among other equal areas, a value wins against no value, and the lowest bits
// win. All texels are computed from the original values.
//
// The neighborhood contains the connected texels in a disc. Within a chart of the atlas, it is an
// ellipse of texels, from the size and shear of the texels in the middle. Where a seam, an open
// edge or a gap is near, connected texels are followed across it, and distances are measured
// straight through space. A flat surface gives the same neighborhood both ways, so a seam changes
// nothing. On curved surfaces, the two differ at most by texels at the rim. At places where texels
// are much smaller than the mean, the neighborhood ends after four times the usual number of
// texels.
//
// Only texels near a border between values are computed. A texel that is farther than three
// quarters of the radius from all borders keeps its value. A row of an ellipse is a few runs of
// equal values with prefix sums of the area, so the time per texel grows with the radius, and only
// near seams with its square. Needs 16 bytes of memory per texel of the map. Fails when cancelled,
// and with an `invalid` error at `radius_mm` for a radius above max_majority_radius.
Result<SurfaceValues> majority(SurfaceValues values, double radius, const mesh::SurfaceMap& map,
                               const mesh::TexelGraph& graph, Progress& progress, int threads = 1);

}  // namespace strata::query
