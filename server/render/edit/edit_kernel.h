#pragma once

#include <vector>

#include "render/edit/block_culler.h"
#include "render/edit/block_test.h"

namespace strata::render {

// What a stroke writes, decided on the CPU.
struct KernelResult {
  struct Tile {
    TileAddress address;
    TileMask written;  // surface and gutter texels
  };
  // only those with a written texel, in the order of the culler
  std::vector<Tile> tiles;
  glm::vec3 written_min{0}, written_max{0};  // model-space box of the blocks written in
  std::size_t tested_blocks = 0;
};

// The texture editing and padding algorithms of the paper, as shaders/edit_pass.comp does them:
// gutter texels carry their owner's position. Reads the surface map in main memory and no GL. Works
// on up to `threads` threads, tile by tile: blocks are culled and tested by the same thread, so
// that a list of them is never made.
KernelResult run_edit_kernel(const mesh::SurfaceMap& map, const BlockCuller& culler,
                             const BlockTest& test, TestBlock test_block, int threads);

}  // namespace strata::render
