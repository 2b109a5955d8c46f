#pragma once

#include <vector>

#include "core/progress.h"
#include "mesh/surface/geometry.h"

namespace strata::mesh {

// The approximate number of triangles of the coarsest level. A processor without GPU draws this
// level in a few milliseconds.
constexpr std::size_t kCoarsestLevelTriangles = 100'000;

// Makes coarser copies of a model for moving cameras, beginning with the finest copy. Each copy has
// about a quarter of the triangles of the next finer one, down to kCoarsestLevelTriangles, by
// `collapse_edges`. The result is empty if the model needs no coarser copy or cannot become coarser
// because of its seams. Copies are for display only. An edit uses the depth of the full model.
// Fails only when cancelled.
Result<std::vector<Geometry>> make_detail_levels(const Geometry& geometry, Progress& progress);

}  // namespace strata::mesh
