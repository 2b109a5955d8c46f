#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "domain/scene/camera.h"
#include "domain/scene/light.h"
#include "gl/buffer.h"
#include "gl/framebuffer.h"
#include "gl/program.h"
#include "gl/texture.h"
#include "render/memory/mesh_buffers.h"
#include "render/renderer.h"
#include "render/view/cluster_culler.h"
#include "shared/mesh.h"

namespace strata::render {

// The parameters for drawing a mesh.
struct MeshView {
  shader::MeshUniforms uniforms;
  bool is_cut = false;  // section planes cut the model
  // The camera swaps left and right, so triangles that face it are clockwise.
  bool is_mirrored = false;
  PartSet hidden_parts{};
  // The members below are for the g-buffer only.
  LightMode light = LightMode::museum;
  bool is_exposed = false;  // brighter or darker than the stored colors
  // At most kMaxSurfaceImagesShown, from bottom to top. The uniforms contain their opacities.
  std::vector<const gl::Texture*> images;
};
// Returns the parameters for a model whose coordinates are relative to `origin`, without images.
MeshView mesh_view(const Camera& camera, const glm::dvec3& origin, const Light& light = {});

// The target of a mesh drawing. The depth texture is attached to the framebuffer and has the size
// of the frame.
struct MeshTarget {
  const gl::Framebuffer& framebuffer;
  const gl::Texture& depth;
  // The only part of the frame that is cleared and drawn. Its pixels are the same as in a drawing
  // of the whole frame. No value: the whole frame.
  std::optional<PixelRect> part{};
};

// The progress of drawing a mesh in slices.
struct MeshProgress {
  // One shader::DrawCommand per cluster, in drawing order. A cluster that contains triangles of
  // hidden and of visible parts has a command for each visible range.
  gl::Buffer commands;
  std::size_t clusters = 0;   // number of commands
  std::size_t triangles = 0;  // of all commands
  std::size_t next_cluster = 0;
  std::size_t next_culling = 0;  // the remaining clusters are culled again before this cluster
  bool cleared = false;
};

// Draws the depth or the g-buffer of a mesh. Draws near parts first and omits the clusters that
// they hide. Both kinds use the same vertex stage, so their depths are equal. Each call sets all GL
// state that it needs, so other passes may run between slices. Back faces are not culled, because
// scans are open.
class MeshPass {
 public:
  enum class Kind { depth, gbuffer };
  static Result<MeshPass> create(Kind kind, const std::filesystem::path& shader_dir,
                                 std::size_t triangles_per_slice);

  // Draws the next slice into `target`, which the first slice clears. Returns true when the mesh is
  // complete.
  Result<bool> draw_slice(const MeshBuffers& mesh, const MeshView& view, const MeshTarget& target,
                          MeshProgress& progress);

 private:
  // Returns the program, which is built at its first use.
  Result<const gl::Program*> program(const MeshView& view, bool lit_at_vertices);
  Result<void> begin(const MeshBuffers& mesh, const MeshView& view, const MeshTarget& target,
                     MeshProgress& progress);

  Kind kind_ = Kind::depth;
  std::filesystem::path shader_dir_;
  std::map<std::vector<std::string>, gl::Program> programs_;  // key: preprocessor definitions
  gl::Buffer uniforms_;
  ClusterCuller culler_;
  std::size_t clusters_per_slice_ = 0;
};

}  // namespace strata::render
