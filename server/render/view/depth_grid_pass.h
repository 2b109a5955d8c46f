#pragma once

#include <filesystem>

#include "gl/buffer.h"
#include "gl/program.h"
#include "gl/texture.h"

namespace strata::render {

// Makes the coarse grid of a depth texture: the largest depth of each cell of kDepthCell² pixels.
// Any point behind this depth is hidden everywhere in the cell.
class DepthGridPass {
 public:
  static Result<DepthGridPass> create(const std::filesystem::path& shader_dir);
  static std::size_t bytes(const gl::Texture& depth);  // one float per cell

  // Writes the grid to `grid`, row by row from the bottom. If `grid` is too small, allocates a new
  // one.
  Result<void> run(const gl::Texture& depth, gl::Buffer& grid) const;

 private:
  gl::Program program_;
};

}  // namespace strata::render
