#pragma once

#include <vector>

#include "shared/depth_probe.h"

namespace strata::render {

// How many cells of the coarse grid lie across so many pixels of a window.
constexpr int depth_cells(int pixels) {
  return (pixels + static_cast<int>(shader::kDepthCell) - 1) / static_cast<int>(shader::kDepthCell);
}

// A depth buffer in main memory, for edits that are decided there. Row by row from below.
struct DepthCopy {
  int width = 0, height = 0;
  std::vector<float> depth;
  // How much the depth changes within half a pixel to either side: the sum, over both axes, of the
  // smaller of two one-sided differences (shaders/edit_pass.comp asks the same of the texture).
  std::vector<float> slope;
  std::vector<float> grid;  // largest depth of each cell of kDepthCell pixels a side
};

// `depth` is of width × height pixels, both above 0. Works on `threads` threads.
DepthCopy make_depth_copy(std::vector<float> depth, int width, int height, int threads);

}  // namespace strata::render
