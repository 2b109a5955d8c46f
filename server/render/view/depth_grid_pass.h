#pragma once

#include <filesystem>

#include "gl/buffer.h"
#include "gl/program.h"
#include "gl/texture.h"

namespace strata::render {

// The coarse grid of a depth texture: the largest depth of each cell of kDepthCell pixels a side.
// Everything behind it in the whole cell is hidden.
class DepthGridPass {
 public:
  static Result<DepthGridPass> create(const std::filesystem::path& shader_dir);
  static std::size_t bytes(const gl::Texture& depth);  // a float a cell

  // Writes the grid to `grid`, row by row from the bottom; allocates it again if it is too small.
  Result<void> run(const gl::Texture& depth, gl::Buffer& grid) const;

 private:
  gl::Program program_;
};

}  // namespace strata::render
