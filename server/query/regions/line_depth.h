#pragma once

#include <string>

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

enum class Line {
  valley,  // the values on the line are less than on both sides
  ridge,   // they are greater
};

// Returns how deep a line lies below its two sides, or how high above them, at each surface texel
// with a value, as f32 in the unit of the values. It is 0 where there is no line, and exact on the
// center of a straight line of half to the whole `width` (model units) between flat sides. Lines of
// a quarter or of one and a half times the width get about 0.7 of their depth. Single pits get more
// than lines, and the foot of a step gets half of the height of the step.
//
// It is the largest second derivative in the tangent plane, of the values smoothed by a Gaussian of
// σ = width / 2, width / √8 and width / 4, times σ² (Lindeberg, "Edge detection and ridge detection
// with automatic scale selection", 1998). The strongest of these scales counts. The derivatives are
// those of a quadratic polynomial, fitted by least squares to the values within 1.75 widths along
// the surface, with Gaussian weights and the true area of the texels. With an unbounded
// neighborhood, this is the same as a convolution with derivatives of the Gaussian. Near unpainted
// texels and open edges, the fit uses one side only. The result does not depend on the atlas,
// except for the sampling. For neighborhoods and folds, see focal_values.
//
// The result has no value if the values around are in a strip too narrow for a fit. The time per
// texel grows with the square of the width. Needs about 20 bytes of memory per texel of the map.
// The result does not depend on the number of threads. Fails when cancelled, and at `field` for a
// width that check_line_width (query/regions/neighborhood_limits) refuses.
Result<SurfaceValues> line_depth_values(Line line, const SurfaceValues& values, ValueType type,
                                        double width, const mesh::SurfaceMap& map,
                                        const mesh::TexelGraph& graph, const std::string& field,
                                        Progress& progress, int threads = 1);

}  // namespace strata::query
