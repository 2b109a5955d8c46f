#pragma once

#include <filesystem>

#include "gl/program.h"
#include "render/memory/mesh_buffers.h"
#include "render/view/depth_grid_pass.h"

namespace strata::render {

// Removes clusters that are hidden by the depth drawn so far from a list of draws, on the GPU:
// indirect draws read the list, so nothing is read back to the CPU. Exact: a cluster that would
// show a pixel keeps its draw. Clusters are not culled by the cone of normals, because scans are
// open and their back sides are shown.
class ClusterCuller {
 public:
  static Result<ClusterCuller> create(const std::filesystem::path& shader_dir);

  // Processes `count` commands from `first` on, which draw clusters of `mesh`; `depth` contains the
  // depth drawn so far.
  Result<void> hide(const gl::Texture& depth, const MeshBuffers& mesh,
                    const glm::mat4& clip_from_model, const gl::Buffer& commands, std::size_t first,
                    std::size_t count);

 private:
  DepthGridPass grid_;
  gl::Program program_;
  gl::Buffer cells_;
};

}  // namespace strata::render
