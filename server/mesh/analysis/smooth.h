#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "mesh/surface/connectivity.h"

namespace strata::mesh {

// Moves each vertex `iterations` times 60 % of the way to the mean of its neighbours; vertices on a
// boundary stay, so that an open mesh does not shrink from its rim, and those that `stays` marks
// (one a vertex; empty: none). `connectivity`: of the triangles.
std::vector<glm::vec3> laplacian_smoothed(std::span<const std::uint32_t> triangles,
                                          const Connectivity& connectivity,
                                          std::span<const glm::vec3> positions, int iterations,
                                          std::span<const std::uint8_t> stays = {});

}  // namespace strata::mesh
