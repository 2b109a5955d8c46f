#pragma once

#include <array>

#include "domain/scene/up.h"
#include "mesh/surface/triangle_mesh.h"

namespace strata::mesh {

// Returns the likelihood of each of kUpDirections for a free-standing object, from its shape alone.
// The shares add up to 1. An object rests on the faces of its convex hull. A direction is more
// likely if the object often comes to rest with this direction up. This probability is the solid
// angle of the ways to drop it (Goldberg et al., "Part pose statistics", 1999). A direction is also
// more likely if the object then rests on a large part of its outline and if hollows open upward. A
// sheet lies with its front up. Most scans have z or y up, so these directions have larger shares.
// Each vertex is read once, which dominates the time for large meshes. Can be called on any thread.
std::array<double, 6> up_shares(const TriangleMesh& mesh);

}  // namespace strata::mesh
