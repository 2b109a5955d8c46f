#pragma once

#include <filesystem>

#include "gl/program.h"
#include "render/memory/mesh_buffers.h"
#include "render/view/depth_grid_pass.h"

namespace strata::render {

// Takes clusters that lie behind what was drawn before them out of a list of draws, on the GPU: the
// list is read by indirect draws, so nothing comes back to the CPU. Exact: a cluster that would
// show a pixel keeps its draw. There is no culling by the cone of normals, because scans are open
// and their back sides are shown.
class ClusterCuller {
 public:
  static Result<ClusterCuller> create(const std::filesystem::path& shader_dir);

  // Of `count` commands from `first` on, which draw clusters of `mesh`; `depth` holds what was
  // drawn.
  Result<void> hide(const gl::Texture& depth, const MeshBuffers& mesh,
                    const glm::mat4& clip_from_model, const gl::Buffer& commands, std::size_t first,
                    std::size_t count);

 private:
  DepthGridPass grid_;
  gl::Program program_;
  gl::Buffer cells_;
};

}  // namespace strata::render
