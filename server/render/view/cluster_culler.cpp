#include "render/view/cluster_culler.h"

#include <glm/gtc/type_ptr.hpp>

#include "shared/cluster.h"

namespace strata::render {

static_assert(shader::kIndicesPerCluster == 3 * mesh::Geometry::kTrianglesPerCluster);
static_assert(sizeof(mesh::ClusterBox) == 6 * sizeof(float));
static_assert(sizeof(shader::DrawCommand) == 20);

Result<ClusterCuller> ClusterCuller::create(const std::filesystem::path& shader_dir) {
  auto grid = STRATA_TRY(DepthGridPass::create(shader_dir));
  auto program = STRATA_TRY(gl::Program::load(shader_dir, {"cluster_cull_pass.comp"}));
  ClusterCuller culler;
  culler.grid_ = std::move(grid);
  culler.program_ = std::move(program);
  return culler;
}

Result<void> ClusterCuller::hide(const gl::Texture& depth, const MeshBuffers& mesh,
                                 const glm::mat4& clip_from_model, const gl::Buffer& commands,
                                 std::size_t first, std::size_t count) {
  STRATA_TRY(grid_.run(depth, cells_));
  program_.use();
  glProgramUniformMatrix4fv(program_.id(), 0, 1, GL_FALSE, glm::value_ptr(clip_from_model));
  program_.set(1, depth.width(), depth.height());
  program_.set(2, static_cast<GLuint>(first));
  program_.set(3, static_cast<GLuint>(count));
  cells_.bind_storage(0);
  mesh.cluster_boxes().bind_storage(1);
  commands.bind_storage(2);
  glDispatchCompute(static_cast<GLuint>(count + 63) / 64, 1, 1);
  glMemoryBarrier(GL_COMMAND_BARRIER_BIT);
  return {};
}

}  // namespace strata::render
