#pragma once

#include <cstdint>
#include <vector>

#include "core/error.h"
#include "mesh/distance/surface_distance.h"
#include "query/regions/region_pieces.h"

namespace strata {
class Progress;
}

namespace strata::query {

// Returns the texels of the center lines of the pieces, ascending (see measure_lines). `depths` are
// the distances from the texels at the border of each piece. Fails when cancelled.
Result<std::vector<std::uint32_t>> thin_pieces(const Pieces& pieces,
                                               const mesh::SurfaceDistances& depths,
                                               const mesh::SurfaceMap& map,
                                               const mesh::TexelGraph& graph, Progress& progress);

}  // namespace strata::query
