#pragma once

#include "core/error.h"
#include "domain/layers/layer.h"
#include "query/regions/surface_values.h"

namespace strata {
class Progress;
}
namespace strata::mesh {
struct TexelGraph;
}

namespace strata::query {

struct Thresholds {
  double low = 0, high = 0;
};

// Returns the value 1 (f32) at the texels above `low` that a path of such texels connects to a
// texel above `high`, and no value elsewhere (Canny, "A computational approach to edge detection",
// 1986). The texels of a path touch at sides or corners, also across seams. `type` is the type of
// `values`. Needs 8 bytes of memory per texel of the map, and the result. Fails when cancelled.
Result<SurfaceValues> hysteresis_values(const SurfaceValues& values, ValueType type,
                                        const Thresholds& thresholds, const mesh::SurfaceMap& map,
                                        const mesh::TexelGraph& graph, Progress& progress);

}  // namespace strata::query
