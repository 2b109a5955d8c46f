#pragma once

#include <vector>

#include "core/progress.h"
#include "mesh/surface/geometry.h"

namespace strata::mesh {

// The coarsest level has about this many triangles: a processor without GPU draws it in a few
// milliseconds.
constexpr std::size_t kCoarsestLevelTriangles = 100'000;

// Makes coarser copies of a model for moving cameras, the finest first: each has about a quarter of
// the triangles of the next finer one, down to kCoarsestLevelTriangles. Edges are collapsed to one
// of their ends (quadric error; meshoptimizer), so every vertex is one of the model's own, with its
// normal, color and texture coordinate; vertices at the seams of the atlas stay on them. Empty for
// a model that needs no coarser copy, or that cannot become coarser because of its seams. Copies
// are for display only: an edit uses the depth of the full model. Refused only when cancelled.
Result<std::vector<Geometry>> make_detail_levels(const Geometry& geometry, Progress& progress);

}  // namespace strata::mesh
