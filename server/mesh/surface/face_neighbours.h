#pragma once

#include <cstdint>
#include <vector>

namespace strata::mesh {

class Connectivity;

constexpr std::uint32_t kNoTriangle = 0xffffffffu;

// Returns the neighboring triangle across each side (entry 3 * triangle + corner), or kNoTriangle
// for an open side.
std::vector<std::uint32_t> face_neighbours(const Connectivity& connectivity);

}  // namespace strata::mesh
