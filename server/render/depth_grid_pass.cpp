#include "render/depth_grid_pass.h"

#include "render/depth_copy.h"

namespace strata::render {

Result<DepthGridPass> DepthGridPass::create(const std::filesystem::path& shader_dir) {
  auto program = gl::Program::load(shader_dir, {"depth_grid_pass.comp"});
  if (!program) return tl::unexpected(program.error());
  DepthGridPass pass;
  pass.program_ = std::move(*program);
  return pass;
}

DepthGridPass::Cells DepthGridPass::all_cells(const gl::Texture& depth) {
  return {0, 0, depth_cells(depth.width()), depth_cells(depth.height())};
}

void DepthGridPass::run(const gl::Texture& depth, const Cells& cells, const gl::Buffer& target) const {
  program_.use();
  program_.set(0, cells.first_x, cells.first_y);
  program_.set(1, cells.width, cells.height);
  depth.bind(0);
  target.bind_storage(0);
  glDispatchCompute(static_cast<GLuint>(cells.width + 7) / 8, static_cast<GLuint>(cells.height + 7) / 8, 1);
}

}  // namespace strata::render
