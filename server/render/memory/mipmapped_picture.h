#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace strata::render {

// A surface image in the layout for the GPU: RGBA8, lowest row first (v = 0), with all mipmap
// levels down to one texel. Coarser texels are means of light, not of sRGB codes, so fine detail
// keeps its brightness. The means are weighted by alpha, so transparent pixels do not darken edges.
struct MipmappedPicture {
  struct Level {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgba;
  };
  std::vector<Level> levels;  // the finest first

  std::size_t bytes() const;
};

// Makes the levels from width x height RGBA8 texels, top row first. Omits levels with a side longer
// than `largest_side`. Takes about a second for 8192² texels on one core.
MipmappedPicture make_mipmaps(std::vector<std::uint8_t> rgba, int width, int height,
                              int largest_side);

}  // namespace strata::render
