#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "mesh/atlas/charts.h"

namespace strata::mesh {

// Returns the faces that cover a texel which an earlier face of their chart covers, at any of the
// given resolutions (powers of two apart, ascending): the faces that remain without them share no
// texel. `corner_uvs` lie in [0,1]²; charts do not touch one another. In the order of charts; does
// not depend on the number of threads.
std::vector<std::uint32_t> faces_in_conflict(std::span<const Chart> charts,
                                             std::span<const glm::vec2> corner_uvs,
                                             std::span<const int> resolutions, int threads = 2);

}  // namespace strata::mesh
