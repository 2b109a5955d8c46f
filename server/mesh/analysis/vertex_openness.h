#pragma once

#include <vector>

#include "core/progress.h"
#include "mesh/surface/geometry.h"

namespace strata::mesh {

// A model with more triangles gets its openness from a coarser copy, because the ray tracer's tree
// takes about 100 bytes per triangle.
constexpr std::size_t kMostTracedTriangles = 2'500'000;

// Computes the share of the surrounding light that reaches each vertex (mesh/analysis/openness.h),
// for the shading of frames. The highest byte of each vertex's color becomes 255 where nothing
// blocks the light, and 0 in a closed cavity. If the outer side seems to be the inside of a thin
// wall, the other side is used, because windings are not always correct. The function traces at
// most about 25 million rays on half of the cores. Every run gives the same result. Fails when
// cancelled or with `out_of_memory`. In both cases the geometry is unchanged.
Result<void> bake_openness(Geometry& geometry, Progress& progress);

// Gives each vertex of `to` the openness of the nearest point of `from`. Both are versions of one
// model.
void copy_openness(const Geometry& from, Geometry& to);

}  // namespace strata::mesh
