#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "mesh/surface/connectivity.h"

namespace strata::mesh {

// Moves each vertex `iterations` times 60 % of the way to the mean of its neighbors. Vertices on a
// boundary do not move, so that an open mesh does not shrink from its rim, nor do those marked in
// `stays` (one entry a vertex; empty: none). `connectivity` is that of the triangles.
std::vector<glm::vec3> laplacian_smoothed(std::span<const std::uint32_t> triangles,
                                          const Connectivity& connectivity,
                                          std::span<const glm::vec3> positions, int iterations,
                                          std::span<const std::uint8_t> stays = {});

}  // namespace strata::mesh
