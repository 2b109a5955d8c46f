#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/camera.h"
#include "gl/framebuffer.h"
#include "gl/readback.h"
#include "render/mesh_pass.h"

namespace strata::render {

// What a depth buffer shows. Equal keys have equal depths.
struct DepthKey {
  std::uint64_t model = 0;
  glm::dmat4 view{1.0}, projection{1.0};
  int width = 0, height = 0;
  bool operator==(const DepthKey&) const = default;
};

// Depth of the full mesh from one camera, with a coarse grid of largest depths that is filled where it is asked for.
struct DepthBuffer {
  DepthKey key;
  bool complete = false;  // every triangle was drawn
  gl::Texture texture;
  gl::Framebuffer framebuffer;
  GpuMemory::Share share;
  int grid_width = 0, grid_height = 0;
  std::vector<float> grid;  // row by row from below; negative: not known yet

  void start(const DepthKey& new_key);  // forgets what it holds
};

// Depth buffers for edits and views: a view's own is shared with edits from the same camera; some recent ones of cameras
// that no view has are kept.
class DepthBuffers {
 public:
  static Result<DepthBuffers> create(const std::filesystem::path& shader_dir, std::size_t triangles_per_slice,
                                     GpuMemory& memory, gl::ReadbackPool& readback);

  Result<std::shared_ptr<DepthBuffer>> make(const DepthKey& key);
  // A view's buffer, for `find`.
  void offer(const std::shared_ptr<DepthBuffer>& buffer);
  std::shared_ptr<DepthBuffer> find(const DepthKey& key);
  // Found or drawn whole; kept as a recent one.
  Result<std::shared_ptr<DepthBuffer>> get(const DepthKey& key, const MeshBuffers& mesh, const Camera& camera);
  bool evict_one();
  void forget_model(std::uint64_t model);

  // Fills the grid over a rectangle of pixels (origin lower left).
  Result<void> fill_grid(DepthBuffer& buffer, double x0, double y0, double x1, double y1);
  // Depth under pixels, which must lie inside the window.
  Result<std::vector<float>> gather(const DepthBuffer& buffer, std::span<const glm::ivec2> pixels);

 private:
  GpuMemory* memory_ = nullptr;
  gl::ReadbackPool* readback_ = nullptr;
  MeshPass pass_;
  gl::Program grid_program_, gather_program_;
  gl::Buffer pixels_;
  std::deque<std::shared_ptr<DepthBuffer>> recent_;  // newest first
  std::vector<std::weak_ptr<DepthBuffer>> offered_;
};

}  // namespace strata::render
