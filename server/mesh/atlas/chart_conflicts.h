#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "mesh/atlas/charts.h"

namespace strata::mesh {

// Returns the faces that cover a texel already covered by an earlier face of their chart, at any of
// the given resolutions. The resolutions are ascending, each a power of two times the first.
// Without these faces, the remaining faces share no texel. `corner_uvs` are in [0,1]², and charts
// do not touch one another. The result is in the order of the charts and does not depend on the
// number of threads.
std::vector<std::uint32_t> faces_in_conflict(std::span<const Chart> charts,
                                             std::span<const glm::vec2> corner_uvs,
                                             std::span<const int> resolutions, int threads = 2);

}  // namespace strata::mesh
