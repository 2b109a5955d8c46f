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

// The content of a depth buffer. Equal keys have equal depths.
struct DepthKey {
  std::uint64_t model = 0;
  glm::dmat4 view{1.0}, projection{1.0};
  int width = 0, height = 0;
  int level = 0;  // of the model's detail; edits need the full mesh, 0
  std::vector<glm::dvec4> section;
  bool operator==(const DepthKey&) const = default;
};
// For a picture of width x height pixels, to which the camera's window is scaled.
DepthKey depth_key(std::uint64_t model, const Camera& camera, int width, int height);

// Depth of a mesh from one camera. Its coarse grid of largest depths and its copy are made on
// demand.
struct DepthBuffer {
  DepthKey key;
  bool complete = false;  // every triangle is drawn
  gl::Texture texture;
  gl::Framebuffer framebuffer;
  GpuMemory::Share share;
  gl::Buffer grid;
  bool has_grid = false;
  std::shared_ptr<const DepthCopy> copy;  // null: not requested yet

  void start(const DepthKey& new_key);  // discards the content
};

// Depth buffers for edits and views: a view shares its own with edits from the same camera; some
// recent ones of cameras without a view are kept.
class DepthBuffers {
 public:
  static Result<DepthBuffers> create(const std::filesystem::path& shader_dir,
                                     std::size_t triangles_per_slice, GpuMemory& memory,
                                     gl::ReadbackPool& readback);

  Result<std::shared_ptr<DepthBuffer>> make(const DepthKey& key);
  // Makes a view's buffer available to `find`.
  void offer(const std::shared_ptr<DepthBuffer>& buffer);
  std::shared_ptr<DepthBuffer> find(const DepthKey& key);
  // Creates a buffer for a camera for which `find` has none; `draw_slice` fills it.
  Result<std::shared_ptr<DepthBuffer>> start(const DepthKey& key);
  // True when the mesh is complete; the buffer is then kept as a recent one.
  Result<bool> draw_slice(const std::shared_ptr<DepthBuffer>& buffer, const MeshBuffers& mesh,
                          const Camera& camera, MeshProgress& progress);
  bool evict_one();
  void forget_model(std::uint64_t model);

  // Makes `buffer.copy`, on `threads` threads. Waits for the GPU; a fence placed after the drawing
  // shows when it does not have to wait.
  static void copy_to_memory(DepthBuffer& buffer, int threads);

  // Makes `buffer.grid` (see DepthGridPass).
  Result<void> make_grid(DepthBuffer& buffer) const;
  // Depths under at most kMaxPathPoints pixels, which must lie inside the window.
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
