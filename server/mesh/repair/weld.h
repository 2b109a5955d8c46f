#pragma once

#include <vector>

#include "mesh/surface/triangle_mesh.h"

namespace strata::mesh {

// Redirects every corner to the first used vertex with the same position. −0 equals 0. Returns the
// number of merged vertices. Unused vertices are not changed.
std::uint64_t weld_equal(TriangleMesh& mesh, const std::vector<bool>& used);

// Redirects every corner to the nearest kept vertex within `distance`. A vertex is kept if no
// earlier vertex is within this distance. No vertex therefore moves farther than `distance`, and
// chains of near vertices do not collapse. Coordinates must be finite.
std::uint64_t weld_near(TriangleMesh& mesh, const std::vector<bool>& used, double distance);

}  // namespace strata::mesh
