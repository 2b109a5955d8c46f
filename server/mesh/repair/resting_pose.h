#pragma once

#include <array>

#include "domain/scene/up.h"
#include "mesh/surface/triangle_mesh.h"

namespace strata::mesh {

// How well each of kUpDirections suits an object that stands by itself, from its shape alone:
// shares with the sum 1. An object rests on the faces of its convex hull; what counts for a
// direction is how likely it comes to rest so that this is up (the solid angle of the ways to drop
// it, Goldberg et al., "Part pose statistics", 1999), how much of its outline it rests on, and that
// hollows open upwards. A sheet lies with its front up. Scans are made with z or y up more often
// than not, which decides where the shape does not. Thread: any. Long for many vertices only in
// that it reads each once.
std::array<double, 6> up_shares(const TriangleMesh& mesh);

}  // namespace strata::mesh
