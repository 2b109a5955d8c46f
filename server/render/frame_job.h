#pragma once

#include "render/frame_queue.h"
#include "render/gpu_scene.h"
#include "render/gpu_thread.h"

namespace strata::render {

// One frame of one view: the g-buffer in slices when the camera changed, the shading, the read-back of what changed.
class FrameJob {
 public:
  explicit FrameJob(FrameTask task) : task_(std::move(task)) {}

  ViewHandle view() const { return task_.request.view; }
  Step step(GpuScene& scene);
  void abort(const Problem& problem) { task_.done(tl::unexpected(problem)); }

 private:
  enum class Stage { prepare, gbuffer, shade, readback };
  Result<void> prepare(GpuScene& scene, View& view);
  Result<bool> draw_slice(GpuScene& scene, View& view);  // true when complete
  Result<void> shade(GpuScene& scene, View& view);
  void finish();

  FrameTask task_;
  Stage stage_ = Stage::prepare;
  MeshProgress progress_;
  Frame frame_;
  gl::Readback pixels_;
  double busy_ms_ = 0;
};

}  // namespace strata::render
