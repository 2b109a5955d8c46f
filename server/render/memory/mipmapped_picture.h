#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace strata::render {

// A picture of a model's surface in the layout for the GPU: RGBA8, lowest row first (v = 0), with
// every mipmap down to one texel. Coarser levels average light instead of sRGB codes, weighted by
// alpha, so that fine detail keeps its brightness and transparent pixels do not darken edges.
struct MipmappedPicture {
  struct Level {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgba;
  };
  std::vector<Level> levels;  // the finest first

  std::size_t bytes() const;
};

// Makes the levels from width x height RGBA8 texels, top row first. Levels with a side above
// `largest_side` are left out. Takes about a second for 8192² on one core.
MipmappedPicture make_mipmaps(std::vector<std::uint8_t> rgba, int width, int height,
                              int largest_side);

}  // namespace strata::render
