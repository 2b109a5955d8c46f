#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>

#include "mesh/texels/surface_map.h"

namespace strata::mesh {

// The largest values of positions in a box as 21 + 21 + 22 bits. The largest value of each
// component is not used, so a value with all bits set is not a position.
constexpr std::uint32_t kMaxPackedX = (1u << 21) - 2, kMaxPackedY = (1u << 21) - 2,
                        kMaxPackedZ = (1u << 22) - 2;

// Returns the smallest step with which `largest` steps cover `low`…`high`. The step is a power of
// two, and is not finer than floats in this range.
inline float packed_step(float low, float high, std::uint32_t largest) {
  const double farthest = std::max(std::abs(double{low}), std::abs(double{high}));
  int exponent = farthest > 0 ? std::ilogb(farthest) - 23 : -126;
  // Two steps are reserved because the box begins on a whole step and positions may be moved by
  // less than one step.
  const double extent = double{high} - double{low};
  if (extent > 0) exponent = std::max(exponent, std::ilogb(extent / (largest - 2.0)) + 1);
  return static_cast<float>(std::ldexp(1.0, std::max(exponent, -126)));
}

inline SurfaceMap::PackedBox packed_box_of(glm::vec3 low, glm::vec3 high) {
  SurfaceMap::PackedBox box;
  constexpr std::uint32_t kMax[] = {kMaxPackedX, kMaxPackedY, kMaxPackedZ};
  for (int i = 0; i < 3; ++i) {
    box.step[i] = packed_step(low[i], high[i], kMax[i]);
    box.min[i] =
        static_cast<float>(std::floor(double{low[i]} / double{box.step[i]}) * double{box.step[i]});
  }
  return box;
}

// `position` must be in the box.
inline std::uint64_t pack_position(glm::vec3 position, const SurfaceMap::PackedBox& box) {
  const auto axis = [&](int i, std::uint32_t largest) {
    const double steps = (double{position[i]} - double{box.min[i]}) / double{box.step[i]};
    return static_cast<std::uint64_t>(
        std::llround(std::clamp(steps, 0.0, static_cast<double>(largest))));
  };
  return axis(0, kMaxPackedX) | axis(1, kMaxPackedY) << 21 | axis(2, kMaxPackedZ) << 42;
}

inline glm::vec3 unpack_position(std::uint64_t packed, const SurfaceMap::PackedBox& box) {
  const glm::vec3 steps(static_cast<float>(packed & 0x1fffff),
                        static_cast<float>(packed >> 21 & 0x1fffff),
                        static_cast<float>(packed >> 42));
  return box.min + steps * box.step;
}

}  // namespace strata::mesh
