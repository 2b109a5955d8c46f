#pragma once

#include <vector>

#include "core/progress.h"
#include "mesh/surface/geometry.h"

namespace strata::mesh {

// Models with more triangles get the light of a coarser copy: the ray tracer's tree takes some 100
// bytes a triangle.
constexpr std::size_t kMostTracedTriangles = 2'500'000;

// The light from all around that reaches the vertices (mesh/analysis/openness.h), for the shading
// of pictures: the highest byte of each vertex's color becomes 255 in the open and 0 in a closed
// cavity. Where the outside is a thin wall's inside, the other side counts, because windings are
// not always right. Takes at most about 25 million rays, on half of the cores; every run gives the
// same result. Refused when cancelled, and as `out_of_memory`: the geometry is then unchanged.
Result<void> bake_openness(Geometry& geometry, Progress& progress);

// Gives the vertices of `to` the openness of the nearest place of `from`, both of one model.
void copy_openness(const Geometry& from, Geometry& to);

}  // namespace strata::mesh
