#pragma once

#include <vector>

#include "core/progress.h"
#include "mesh/surface/geometry.h"

namespace strata::mesh {

// The coarsest level has about so many triangles: what a processor without GPU draws in a few
// milliseconds.
constexpr std::size_t kCoarsestLevelTriangles = 100'000;

// Coarser copies of a model for moving cameras, the finest first: each has about a quarter of the
// triangles of the next finer one, down to kCoarsestLevelTriangles. Edges are collapsed to one of
// their ends (quadric error; meshoptimizer), so every vertex is one of the model's own, with its
// normal, colour and texture coordinate; those at the seams of the atlas stay on them. Empty for a
// model that needs no coarser copy, or that its seams keep from getting coarser. They are for
// looking at only: an edit's depth is the full model's. Refused only when cancelled.
Result<std::vector<Geometry>> make_detail_levels(const Geometry& geometry, Progress& progress);

}  // namespace strata::mesh
