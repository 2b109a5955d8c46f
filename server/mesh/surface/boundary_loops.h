#pragma once

#include <vector>

#include "mesh/surface/connectivity.h"

namespace strata::mesh {

// The open sides of triangles along one rim of the mesh, in their direction. Each side begins at
// the end of the previous side, and the first begins at the end of the last.
using BoundaryLoop = std::vector<OpenMesh::HalfedgeHandle>;

// Every open side is in one loop. If two rims touch in a vertex, each rim continues along its own
// triangles. Pieces that touch only there therefore have separate loops.
std::vector<BoundaryLoop> boundary_loops(const Connectivity& connectivity);

}  // namespace strata::mesh
