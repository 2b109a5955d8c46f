#pragma once

#include <array>

#include "domain/scene/up.h"
#include "mesh/surface/triangle_mesh.h"

namespace strata::mesh {

// Likelihood of each of kUpDirections for a free-standing object, from its shape alone: shares with
// the sum 1. An object rests on the faces of its convex hull. A direction is more likely if the
// object often comes to rest with it up (the solid angle of the ways to drop it, Goldberg et al.,
// "Part pose statistics", 1999), if it then rests on a large part of its outline, and if hollows
// open upwards. A sheet lies with its front up. Most scans have z or y up, which decides where the
// shape does not. Reads each vertex once, which determines its time for large meshes. Any thread.
std::array<double, 6> up_shares(const TriangleMesh& mesh);

}  // namespace strata::mesh
