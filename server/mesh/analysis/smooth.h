#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "mesh/surface/connectivity.h"

namespace strata::mesh {

// Moves each vertex 60 % of the way to the mean of its neighbors and repeats this `iterations`
// times. Vertices on a boundary do not move, so an open mesh does not shrink from its rim. The
// vertices marked in `stays` do not move either. `stays` has one entry per vertex or is empty.
// `connectivity` belongs to the same triangles.
std::vector<glm::vec3> laplacian_smoothed(std::span<const std::uint32_t> triangles,
                                          const Connectivity& connectivity,
                                          std::span<const glm::vec3> positions, int iterations,
                                          std::span<const std::uint8_t> stays = {});

}  // namespace strata::mesh
