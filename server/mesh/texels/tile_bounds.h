#pragma once

#include <vector>

#include "mesh/surface/block_tree.h"

namespace strata::mesh {

struct Geometry;

// Returns spheres around the surface in each tile of an atlas at a resolution, row-major. Like
// SurfaceMap::bounds_of_tile, but without a map, and larger: a sphere contains whole triangles. An
// empty tile has a negative radius.
std::vector<BoundingSphere> bound_tiles(const Geometry& geometry, int resolution);

}  // namespace strata::mesh
