#pragma once

#include <array>

namespace strata::mesh {

constexpr int kGutterRing = 2;  // width in texels of the gutter around an island

struct TexelOffset {
  int x, y;
};

// The 24 neighbors within kGutterRing texels, nearest first. Of equally near neighbors, the lower
// comes first, then the left. A gutter texel follows the first neighbor in this order that is a
// surface texel.
constexpr std::array<TexelOffset, 24> gutter_ring_offsets() {
  std::array<TexelOffset, 24> offsets{};
  int count = 0;
  for (const int squared : {1, 2, 4, 5, 8})
    for (int y = -kGutterRing; y <= kGutterRing; ++y)
      for (int x = -kGutterRing; x <= kGutterRing; ++x)
        if (x * x + y * y == squared) offsets[count++] = {x, y};
  return offsets;
}
constexpr auto kGutterRingOffsets = gutter_ring_offsets();

}  // namespace strata::mesh
