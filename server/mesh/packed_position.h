#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/glm.hpp>

namespace strata::mesh {

// Positions in a box as 21 + 21 + 22 bits; the largest value of each is left out, so that all ones is no position.
constexpr std::uint32_t kLargestPackedX = (1u << 21) - 2, kLargestPackedY = (1u << 21) - 2,
                        kLargestPackedZ = (1u << 22) - 2;

// `q`: position in the box scaled to 0…kLargestPacked per axis.
inline std::uint64_t pack_quantised(glm::dvec3 q) {
  const auto axis = [](double value, std::uint32_t largest) {
    return static_cast<std::uint64_t>(std::clamp(value, 0.0, static_cast<double>(largest)) + 0.5);
  };
  return axis(q.x, kLargestPackedX) | axis(q.y, kLargestPackedY) << 21 | axis(q.z, kLargestPackedZ) << 42;
}

inline glm::uvec3 unpack_quantised(std::uint64_t packed) {
  return {static_cast<std::uint32_t>(packed & 0x1fffff), static_cast<std::uint32_t>(packed >> 21 & 0x1fffff),
          static_cast<std::uint32_t>(packed >> 42)};
}

inline glm::vec3 unpack_position(std::uint64_t packed, glm::vec3 box_min, glm::vec3 box_extent) {
  const glm::vec3 largest(kLargestPackedX, kLargestPackedY, kLargestPackedZ);
  return box_min + glm::vec3(unpack_quantised(packed)) / largest * box_extent;
}

}  // namespace strata::mesh
