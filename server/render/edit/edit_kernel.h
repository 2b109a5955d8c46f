#pragma once

#include <vector>

#include "render/edit/block_culler.h"
#include "render/edit/block_test.h"

namespace strata::render {

// The texels that a stroke writes, computed on the CPU.
struct KernelResult {
  struct Tile {
    TileAddress address;
    TileMask written;  // surface and gutter texels
  };
  // only tiles with a written texel, in the order of the culler
  std::vector<Tile> tiles;
  glm::vec3 written_min{0}, written_max{0};  // model-space box of the written blocks
  std::size_t tested_blocks = 0;
};

// The texture editing and padding algorithms of the paper, as in shaders/edit_pass.comp: gutter
// texels have their owner's position. Reads the surface map in main memory and does not use GL.
// Uses up to `threads` threads, tile by tile: the same thread culls and tests blocks, so that no
// list of blocks is stored.
KernelResult run_edit_kernel(const mesh::SurfaceMap& map, const BlockCuller& culler,
                             const BlockTest& test, TestBlock test_block, int threads);

}  // namespace strata::render
