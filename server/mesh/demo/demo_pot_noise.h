#pragma once

#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>

namespace strata::mesh {

// Smooth value noise in [-1,1] from integer hashes. It is the same on every machine.
inline double lattice_noise(int x, int y, int z) {
  std::uint32_t h = static_cast<std::uint32_t>(x) * 0x8da6b343u ^
                    static_cast<std::uint32_t>(y) * 0xd8163841u ^
                    static_cast<std::uint32_t>(z) * 0xcb1ab31fu;
  h = (h ^ h >> 15) * 0x2c1b3c6du;
  h = (h ^ h >> 12) * 0x297a2d39u;
  h ^= h >> 15;
  return static_cast<double>(h & 0xffffffu) / 8388607.5 - 1.0;
}

inline double noise(const glm::dvec3& p) {
  const glm::dvec3 cell = glm::floor(p);
  const glm::dvec3 f = p - cell, s = f * f * (3.0 - 2.0 * f);
  const int x = static_cast<int>(cell.x), y = static_cast<int>(cell.y),
            z = static_cast<int>(cell.z);
  const auto row = [&](int dy, int dz) {
    return glm::mix(lattice_noise(x, y + dy, z + dz), lattice_noise(x + 1, y + dy, z + dz), s.x);
  };
  return glm::mix(glm::mix(row(0, 0), row(1, 0), s.y), glm::mix(row(0, 1), row(1, 1), s.y), s.z);
}

inline double fractal_noise(glm::dvec3 p, int octaves) {
  double sum = 0, weight = 0.5;
  for (int i = 0; i < octaves; ++i) {
    sum += weight * noise(p);
    p = p * 2.03 + 19.7;
    weight *= 0.5;
  }
  return sum;
}

}  // namespace strata::mesh
