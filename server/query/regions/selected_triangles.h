#pragma once

#include <cstdint>
#include <vector>

#include "core/error.h"
#include "core/progress.h"
#include "mesh/surface/geometry.h"
#include "query/conditions/texel_selection.h"

namespace strata::query {

// Returns an upper limit of the memory in bytes that `selected_triangles` needs, with its result.
std::uint64_t bytes_to_select_triangles(const mesh::Geometry& geometry, int resolution);

// Returns the triangles that own a selected texel, in their order, with three indices each. A
// triangle that owns no texel, because it is smaller than the texels, is selected if the texel at
// its center is. `selected` belongs to the surface map of this resolution. Fails when cancelled.
Result<std::vector<std::uint32_t>> selected_triangles(const mesh::Geometry& geometry,
                                                      int resolution,
                                                      const TexelSelection& selected,
                                                      Progress& progress);

}  // namespace strata::query
