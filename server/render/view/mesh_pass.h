#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "domain/scene/camera.h"
#include "domain/scene/light.h"
#include "gl/buffer.h"
#include "gl/framebuffer.h"
#include "gl/program.h"
#include "gl/texture.h"
#include "render/memory/mesh_buffers.h"
#include "render/view/cluster_culler.h"
#include "shared/mesh.h"

namespace strata::render {

// The parameters for drawing a mesh.
struct MeshView {
  shader::MeshUniforms uniforms;
  bool is_cut = false;  // by section planes
  // the camera swaps left and right: triangles that face it are clockwise
  bool is_mirrored = false;
  // For the g-buffer.
  LightMode light = LightMode::museum;
  bool is_exposed = false;  // brighter or darker than the colors as they are stored
  // bottom to top, at most kMaxSurfaceImages, with their opacity in the uniforms
  std::vector<const gl::Texture*> images;
};
// For a model whose coordinates are relative to `origin`; without images.
MeshView mesh_view(const Camera& camera, const glm::dvec3& origin, const Light& light = {});

// The target of a mesh drawing. The depth texture belongs to the framebuffer and has the window's
// size.
struct MeshTarget {
  const gl::Framebuffer& framebuffer;
  const gl::Texture& depth;
};

// Progress of drawing a mesh in slices.
struct MeshProgress {
  gl::Buffer commands;       // shader::DrawCommand: clusters in drawing order
  std::size_t clusters = 0;  // in the window
  std::size_t next_cluster = 0;
  std::size_t next_culling = 0;  // the cluster at which those that follow are culled again
  bool cleared = false;

  std::size_t triangles() const { return clusters * mesh::Geometry::kTrianglesPerCluster; }
};

// Draws a mesh, near parts first, and leaves out clusters hidden by them: depth only, or the
// g-buffer. Both use one vertex stage, so their depths are equal. Each call sets all state it
// needs: other passes may run between slices. Back faces are not culled, because scans are open.
class MeshPass {
 public:
  enum class Kind { depth, gbuffer };
  static Result<MeshPass> create(Kind kind, const std::filesystem::path& shader_dir,
                                 std::size_t triangles_per_slice);

  // Draws the next slice into `target` (cleared before the first); true when the mesh is complete.
  Result<bool> draw_slice(const MeshBuffers& mesh, const MeshView& view, const MeshTarget& target,
                          MeshProgress& progress);

 private:
  // Built on first use.
  Result<const gl::Program*> program(const MeshView& view, bool lit_at_vertices);
  Result<void> begin(const MeshBuffers& mesh, const MeshView& view, const MeshTarget& target,
                     MeshProgress& progress);

  Kind kind_ = Kind::depth;
  std::filesystem::path shader_dir_;
  std::map<std::vector<std::string>, gl::Program> programs_;  // by their defines
  gl::Buffer uniforms_;
  ClusterCuller culler_;
  std::size_t clusters_per_slice_ = 0;
};

}  // namespace strata::render
