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

// What a depth buffer shows. Equal keys have equal depths.
struct DepthKey {
  std::uint64_t model = 0;
  glm::dmat4 view{1.0}, projection{1.0};
  int width = 0, height = 0;
  int level = 0;  // of the model's detail; edits need the full mesh, 0
  std::vector<glm::dvec4> section;
  bool operator==(const DepthKey&) const = default;
};
// Of a picture of width x height pixels, which the camera's window is scaled to.
DepthKey depth_key(std::uint64_t model, const Camera& camera, int width, int height);

// Depth of a mesh from one camera; its coarse grid of largest depths and its copy are made when
// first asked for.
struct DepthBuffer {
  DepthKey key;
  bool complete = false;  // every triangle was drawn
  gl::Texture texture;
  gl::Framebuffer framebuffer;
  GpuMemory::Share share;
  gl::Buffer grid;
  bool has_grid = false;
  std::shared_ptr<const DepthCopy> copy;  // null: nobody asked for it yet

  void start(const DepthKey& new_key);  // forgets what it holds
};

// Depth buffers for edits and views: a view's own is shared with edits from the same camera; some
// recent ones of cameras that no view has are kept.
class DepthBuffers {
 public:
  static Result<DepthBuffers> create(const std::filesystem::path& shader_dir,
                                     std::size_t triangles_per_slice, GpuMemory& memory,
                                     gl::ReadbackPool& readback);

  Result<std::shared_ptr<DepthBuffer>> make(const DepthKey& key);
  // A view's buffer, for `find`.
  void offer(const std::shared_ptr<DepthBuffer>& buffer);
  std::shared_ptr<DepthBuffer> find(const DepthKey& key);
  // For a camera that no buffer is found for: one to be drawn by `draw_slice`.
  Result<std::shared_ptr<DepthBuffer>> start(const DepthKey& key);
  // True when the mesh is complete; the buffer is then kept as a recent one.
  Result<bool> draw_slice(const std::shared_ptr<DepthBuffer>& buffer, const MeshBuffers& mesh,
                          const Camera& camera, MeshProgress& progress);
  bool evict_one();
  void forget_model(std::uint64_t model);

  // Makes `buffer.copy`, on `threads` threads. Waits for the GPU: a fence after the drawing tells
  // when it does not.
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
