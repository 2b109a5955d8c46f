#pragma once

#include <vector>

#include "shared/depth_probe.h"

namespace strata::render {

// Returns the number of grid cells that cover a side of `pixels` pixels.
constexpr int depth_cells(int pixels) {
  return (pixels + static_cast<int>(shader::kDepthCell) - 1) / static_cast<int>(shader::kDepthCell);
}

// A depth buffer in main memory, for edits on the CPU. Row by row from the bottom.
struct DepthCopy {
  int width = 0, height = 0;
  std::vector<float> depth;
  // The change of depth within half a pixel: the sum, over both axes, of the smaller of two
  // one-sided differences. shaders/edit_pass.comp computes the same values from the texture.
  std::vector<float> slope;
  std::vector<float> grid;  // largest depth of each cell of kDepthCell² pixels
};

// `depth` contains width × height pixels, both above 0. Uses `threads` threads.
DepthCopy make_depth_copy(std::vector<float> depth, int width, int height, int threads);

}  // namespace strata::render
