#pragma once

#include <vector>

#include "shared/depth_probe.h"

namespace strata::render {

// The number of cells of the coarse grid across this many pixels of a window.
constexpr int depth_cells(int pixels) {
  return (pixels + static_cast<int>(shader::kDepthCell) - 1) / static_cast<int>(shader::kDepthCell);
}

// A depth buffer in main memory, for edits computed on the CPU. Row by row from the bottom.
struct DepthCopy {
  int width = 0, height = 0;
  std::vector<float> depth;
  // The change of depth within half a pixel to either side: the sum, over both axes, of the smaller
  // of two one-sided differences (shaders/edit_pass.comp computes the same from the texture).
  std::vector<float> slope;
  std::vector<float> grid;  // largest depth of each cell of kDepthCell pixels a side
};

// `depth` has width × height pixels, both above 0. Uses `threads` threads.
DepthCopy make_depth_copy(std::vector<float> depth, int width, int height, int threads);

}  // namespace strata::render
