#pragma once

#include <vector>

#include "mesh/surface/triangle_mesh.h"

namespace strata::mesh {

// Points every corner at the first used vertex with the same position; −0 equals 0. Returns the
// number of merged vertices. Unused vertices are not changed.
std::uint64_t weld_equal(TriangleMesh& mesh, const std::vector<bool>& used);

// Points every corner at the nearest of the kept vertices, where one lies within `distance`; a
// vertex without an earlier one in this distance is kept. So no vertex moves farther than
// `distance`, and chains of near vertices do not collapse. Finite coordinates only.
std::uint64_t weld_near(TriangleMesh& mesh, const std::vector<bool>& used, double distance);

}  // namespace strata::mesh
