#pragma once

#include <vector>

#include "mesh/surface/triangle_mesh.h"

namespace strata::mesh {

// Points every corner at the first used vertex with the same position; −0 is 0. Returns how many
// vertices were merged. What is not used stays where it is.
std::uint64_t weld_equal(TriangleMesh& mesh, const std::vector<bool>& used);

// Points every corner at the nearest of the vertices that stay, where one lies within `distance`; a
// vertex stays that has none before it. So nothing moves farther than `distance`, and nothing is
// drawn along in chains. Finite coordinates only.
std::uint64_t weld_near(TriangleMesh& mesh, const std::vector<bool>& used, double distance);

}  // namespace strata::mesh
