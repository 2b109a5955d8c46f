#pragma once

#include <filesystem>

#include "gl/buffer.h"
#include "gl/program.h"
#include "gl/texture.h"

namespace strata::render {

// The coarse grid of a depth texture: the largest depth of each cell of kDepthCell pixels a side. What lies behind it in the
// whole cell is hidden.
class DepthGridPass {
 public:
  struct Cells {
    int first_x = 0, first_y = 0, width = 0, height = 0;
    std::size_t bytes() const {
      return static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * sizeof(float);
    }
  };
  static Result<DepthGridPass> create(const std::filesystem::path& shader_dir);
  static Cells all_cells(const gl::Texture& depth);

  // Row by row from below into `target`, which a reader must put a barrier before.
  void run(const gl::Texture& depth, const Cells& cells, const gl::Buffer& target) const;

 private:
  gl::Program program_;
};

}  // namespace strata::render
