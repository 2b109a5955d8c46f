#pragma once

#include <vector>

#include "mesh/surface/connectivity.h"

namespace strata::mesh {

// The open sides of triangles along one rim of the mesh, in their direction: each begins where the
// one before it ends, and the first where the last ends.
using BoundaryLoop = std::vector<OpenMesh::HalfedgeHandle>;

// Every open side is in one of them. Where two rims touch in a vertex, each goes on along its own
// triangles, so that pieces that touch only there have loops of their own.
std::vector<BoundaryLoop> boundary_loops(const Connectivity& connectivity);

}  // namespace strata::mesh
