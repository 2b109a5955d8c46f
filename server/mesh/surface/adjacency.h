#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace strata::mesh {

constexpr std::uint32_t kNoTriangle = 0xffffffffu;

// Across each edge (corner k → corner k+1 of a triangle: entry 3 * triangle + k) the neighbouring
// triangle, or kNoTriangle where the edge is a boundary, is shared by more than two triangles, or
// joins two of opposite orientation.
std::vector<std::uint32_t> edge_neighbours(std::span<const std::uint32_t> triangles,
                                           std::size_t vertex_count);

}  // namespace strata::mesh
