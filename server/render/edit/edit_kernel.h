#pragma once

#include <vector>

#include "render/edit/block_culler.h"
#include "render/edit/block_test.h"

namespace strata::render {

// The texels that a stroke writes, as computed on the CPU.
struct KernelResult {
  struct Tile {
    TileAddress address;
    TileMask written;  // written surface and gutter texels
  };
  // The tiles with written texels, row by row.
  std::vector<Tile> tiles;
  glm::vec3 written_min{0}, written_max{0};  // model-space box of the written blocks
  std::size_t tested_blocks = 0;
};

// Runs the texture editing and padding algorithms (TEA and TPA), as in shaders/edit_pass.comp. A
// gutter texel has the position of its owner. Reads the surface map in main memory and does not use
// GL. Uses up to `threads` threads. Each thread culls and tests the blocks of one tile at a time,
// so no list of all blocks is stored.
KernelResult run_edit_kernel(const mesh::SurfaceMap& map, const BlockCuller& culler,
                             const BlockTest& test, TestBlock test_block, int threads);

}  // namespace strata::render
