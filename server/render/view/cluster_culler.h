#pragma once

#include <filesystem>

#include "gl/program.h"
#include "render/memory/mesh_buffers.h"
#include "render/view/depth_grid_pass.h"

namespace strata::render {

// Disables the draws of clusters that are hidden by the depth drawn so far. Runs on the GPU.
// Indirect draws read the list, so the CPU reads nothing back. A cluster with a visible pixel
// always keeps its draw. Clusters are not culled by their cones of normals, because scans are open
// and their back sides are visible.
class ClusterCuller {
 public:
  static Result<ClusterCuller> create(const std::filesystem::path& shader_dir);

  // Processes `count` commands, starting at `first`. The commands draw clusters of `mesh`. `depth`
  // contains the depth drawn so far.
  Result<void> hide(const gl::Texture& depth, const MeshBuffers& mesh,
                    const glm::mat4& clip_from_model, const gl::Buffer& commands, std::size_t first,
                    std::size_t count);

 private:
  DepthGridPass grid_;
  gl::Program program_;
  gl::Buffer cells_;
};

}  // namespace strata::render
