#pragma once

#include <vector>

#include "mesh/surface/connectivity.h"

namespace strata::mesh {

// The open sides of triangles along one rim of the mesh, in their direction: each begins at the end
// of the one before it, and the first at the end of the last.
using BoundaryLoop = std::vector<OpenMesh::HalfedgeHandle>;

// Every open side is in one loop. Where two rims touch in a vertex, each continues along its own
// triangles, so that pieces that touch only there have separate loops.
std::vector<BoundaryLoop> boundary_loops(const Connectivity& connectivity);

}  // namespace strata::mesh
