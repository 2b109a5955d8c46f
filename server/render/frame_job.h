#pragma once

#include <chrono>

#include "render/frame_queue.h"
#include "render/gpu_scene.h"
#include "render/gpu_thread.h"

namespace strata::render {

// One frame, drawn by one view: the g-buffer in slices when the camera changed, then what changed is shaded and read back in
// bands.
class FrameJob {
 public:
  explicit FrameJob(FrameTask task) : task_(std::move(task)) {}

  const FrameTask& task() const { return task_; }
  double busy_ms() const { return busy_ms_; }
  // With what its asker has been served by now.
  FrameTask::Turn turn() const {
    return {task_.turn.acting, task_.turn.ms + busy_ms_ / static_cast<double>(task_.askers.size())};
  }
  Step step(GpuScene& scene);
  void abort(const Problem& problem) { answer(tl::unexpected(problem)); }

 private:
  void answer(const Result<SharedFrame>& frame) {
    for (const auto& asker : task_.askers) asker.done(frame);
  }
  enum class Stage { prepare, layers, gbuffer, area, shade, readback };
  Result<void> prepare(GpuScene& scene, View& view);
  Result<bool> bring_layers(GpuScene& scene);  // true when all are on the GPU
  Result<int> choose_level(GpuScene& scene, const View& view) const;
  Result<bool> draw_slice(GpuScene& scene, View& view);  // true when complete
  Result<void> choose_area(GpuScene& scene, View& view);
  Result<bool> shade_band(GpuScene& scene, View& view);  // true when complete
  std::size_t row_bytes() const { return std::size_t{4} * static_cast<std::size_t>(frame_.rect.width); }
  bool collect_rows();  // true when complete

  FrameTask task_;
  Stage stage_ = Stage::prepare;
  std::vector<std::shared_ptr<const void>> layer_uses_;
  MeshProgress progress_;
  std::chrono::steady_clock::time_point mesh_begin_;  // when its first slice was drawn
  Frame frame_;
  PixelRect surface_;    // of `frame_.rect`: may show surface
  int shaded_rows_ = 0;  // of `frame_.rect`, from its top
  gl::Readback pixels_;  // lowest row first
  double busy_ms_ = 0;
};

}  // namespace strata::render
