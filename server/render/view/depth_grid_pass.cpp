#include "render/view/depth_grid_pass.h"

#include "render/view/depth_copy.h"

namespace strata::render {

Result<DepthGridPass> DepthGridPass::create(const std::filesystem::path& shader_dir) {
  auto program = STRATA_TRY(gl::Program::load(shader_dir, {"depth_grid_pass.comp"}));
  DepthGridPass pass;
  pass.program_ = std::move(program);
  return pass;
}

std::size_t DepthGridPass::bytes(const gl::Texture& depth) {
  return static_cast<std::size_t>(depth_cells(depth.width())) *
         static_cast<std::size_t>(depth_cells(depth.height())) * sizeof(float);
}

Result<void> DepthGridPass::run(const gl::Texture& depth, gl::Buffer& grid) const {
  if (grid.size() < bytes(depth)) {
    auto made = STRATA_TRY(gl::Buffer::create(bytes(depth), gl::Buffer::Use::fixed, "depth grid"));
    grid = std::move(made);
  }
  const int width = depth_cells(depth.width()), height = depth_cells(depth.height());
  program_.use();
  program_.set(0, width, height);
  depth.bind(0);
  grid.bind_storage(0);
  glDispatchCompute(static_cast<GLuint>(width + 7) / 8, static_cast<GLuint>(height + 7) / 8, 1);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  return {};
}

}  // namespace strata::render
