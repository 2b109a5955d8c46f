#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "domain/scene/camera.h"
#include "gl/framebuffer.h"
#include "gl/readback.h"
#include "render/edit/tool_path.h"
#include "render/view/depth_copy.h"
#include "render/view/depth_grid_pass.h"
#include "render/view/mesh_pass.h"

namespace strata::render {

// Identifies the content of a depth buffer: equal keys mean equal depths.
struct DepthKey {
  std::uint64_t model = 0;
  glm::dmat4 view{1.0}, projection{1.0};
  int width = 0, height = 0;
  int level = 0;  // level of detail; edits need 0, the full mesh
  std::vector<glm::dvec4> section;
  PartSet hidden_parts;
  bool operator==(const DepthKey&) const = default;
};
// Returns the key for a frame of width x height pixels, to which the camera's window is scaled.
DepthKey depth_key(std::uint64_t model, const Camera& camera, int width, int height);

// The depth of a mesh from one camera. Its coarse grid of largest depths and its copy in main
// memory are made on demand.
struct DepthBuffer {
  DepthKey key;
  bool complete = false;  // all triangles are drawn
  gl::Texture texture;
  gl::Framebuffer framebuffer;
  GpuMemory::Share share;
  gl::Buffer grid;
  bool has_grid = false;
  std::shared_ptr<const DepthCopy> copy;  // null until it is requested

  void start(const DepthKey& new_key);  // discards the old content
};

// Depth buffers for edits and views. A view shares its buffer with edits from the same camera. For
// cameras without a view, a few recent buffers are kept.
class DepthBuffers {
 public:
  static Result<DepthBuffers> create(const std::filesystem::path& shader_dir,
                                     std::size_t triangles_per_slice, GpuMemory& memory,
                                     gl::ReadbackPool& readback);

  Result<std::shared_ptr<DepthBuffer>> make(const DepthKey& key);
  // Makes a view's buffer available to `find`, which returns null if it finds no buffer.
  void offer(const std::shared_ptr<DepthBuffer>& buffer);
  std::shared_ptr<DepthBuffer> find(const DepthKey& key);
  // Provides a buffer for a key that `find` does not find. `draw_slice` fills it.
  Result<std::shared_ptr<DepthBuffer>> start(const DepthKey& key);
  // Returns true when the mesh is complete. The buffer is then kept as a recent one.
  Result<bool> draw_slice(const std::shared_ptr<DepthBuffer>& buffer, const MeshBuffers& mesh,
                          const Camera& camera, MeshProgress& progress);
  bool evict_one();
  void forget_model(std::uint64_t model);

  // Makes `buffer.copy` with `threads` threads. Waits for the GPU. To avoid the wait, place a fence
  // after the drawing and call this function when the fence has passed.
  static void copy_to_memory(DepthBuffer& buffer, int threads);

  // Makes `buffer.grid` on demand (see DepthGridPass).
  Result<void> make_grid(DepthBuffer& buffer) const;
  // Starts to read the depths of at most kMaxPathPoints pixels, which must be inside the window.
  Result<gl::Readback> begin_gather(const DepthBuffer& buffer, std::span<const glm::ivec2> pixels);
  static std::vector<float> finish_gather(const gl::Readback& depths);

 private:
  GpuMemory* memory_ = nullptr;
  gl::ReadbackPool* readback_ = nullptr;
  MeshPass pass_;
  DepthGridPass grid_pass_;
  gl::Program gather_program_;
  gl::Buffer pixels_;
  std::deque<std::shared_ptr<DepthBuffer>> recent_;  // newest first
  std::vector<std::weak_ptr<DepthBuffer>> offered_;
};

}  // namespace strata::render
