#pragma once

#include <vector>

#include "core/error.h"
#include "query/regions/region_pieces.h"

namespace strata {
class Progress;
}
namespace strata::mesh {
struct TexelGraph;
}

namespace strata::query {

// A piece as a line with a width, such as a crack. Lengths are in model units, along the surface.
struct LineMeasures {
  double length = 0;          // of the center line with its branches, up to the ends of the piece
  double width = 0;           // mean: the area divided by the length
  double greatest_width = 0;  // of the widest place
};

// Returns the measures of each piece.
//
// The center line is what remains of the piece when texels are taken away from its border inwards,
// as long as pieces and their holes stay connected and lines keep their ends (Pudney,
// "Distance-ordered homotopic thinning", 1998). Texels that touch at corners are connected, also
// across seams. Branches and small loops shorter than the width of the line do not count, and
// neither do branches of less than 3 texels. The length is that of the simplified line (Douglas and
// Peucker, 1973) with a tolerance of 1.5 texels, or of an eighth of the width if that is more, so
// the steps of the texels add nothing. A round piece has its diameter as its length.
//
// The error of the length of lines much longer than wide is at most about 5 %. At each sharp
// corner, the line is shorter by up to 0.4 of its width. The greatest width is exact to about a
// texel, or two texels near seams. At junctions, it is the width of the junction.
//
// The time is proportional to the texels of the pieces. Needs about 24 bytes of memory per texel of
// the map, and 2 KiB per texel at a seam (mesh/distance/surface_distance.h). The result does not
// depend on the number of threads. Fails when cancelled.
Result<std::vector<LineMeasures>> measure_lines(const Pieces& pieces, const mesh::SurfaceMap& map,
                                                const mesh::TexelGraph& graph, Progress& progress,
                                                int threads = 1);

}  // namespace strata::query
