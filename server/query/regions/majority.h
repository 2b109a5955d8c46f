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

// The largest number of texels near borders times the square of the radius in texels: one to two
// minutes on two cores.
inline constexpr double kMaxMajorityWork = 4e9;

struct MajorityRequest {
  double radius = 0;           // model units
  double metres_per_unit = 1;  // for the messages of errors
  double max_work = kMaxMajorityWork;
};

// Gives each surface texel the value with the largest area within the radius around it.
// "No value" counts like a value. The own value of the texel wins against areas that are larger by
// less than 1 in 10⁴. Among other equal areas, a value wins against no value, and the lowest bits
// win. All texels are computed from the original values.
//
// The neighborhood contains the connected texels in a disc. Near a seam, an open edge or a gap,
// distances are measured straight through space. TexelDiscs (query/regions/texel_discs) states how
// far the rim can be from the radius.
//
// Only texels near a border between values are computed. A texel that is farther than three
// quarters of the radius from all borders keeps its value. A row of an ellipse is a few runs of
// equal values with prefix sums of the area, so the time per texel grows with the radius, and only
// near seams with its square. Needs at most 36 bytes of memory per texel of the map. Fails when
// cancelled, and with an `invalid` error at `radius_mm` for a radius that check_majority_radius
// (query/regions/neighborhood_limits) refuses or with more work than `max_work`. The message states
// the largest radius.
Result<SurfaceValues> majority(SurfaceValues values, const MajorityRequest& request,
                               const mesh::SurfaceMap& map, const mesh::TexelGraph& graph,
                               Progress& progress, int threads = 1);

}  // namespace strata::query
