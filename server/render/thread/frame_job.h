#pragma once

#include <chrono>

#include "render/thread/frame_queue.h"
#include "render/thread/gpu_scene.h"
#include "render/thread/gpu_thread.h"

namespace strata::render {

// One frame, drawn by one view: the g-buffer in slices when the camera changed, then what changed
// is shaded and read back in bands.
class FrameJob {
 public:
  explicit FrameJob(FrameTask task) : task_(std::move(task)) {}

  const FrameTask& task() const { return task_; }
  double busy_ms() const { return busy_ms_; }
  // With what its asker has been served by now.
  FrameTask::Turn turn() const {
    return {task_.turn.acting, task_.turn.ms + busy_ms_ / static_cast<double>(task_.askers.size()),
            task_.turn.large};
  }
  Step step(GpuScene& scene);
  void abort(const Error& problem) { answer(tl::unexpected(problem)); }

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
  bool collect_rows();                                   // true when complete

  // How far one walk over the rows of all rectangles has come, each from its top.
  struct Rows {
    std::size_t rect = 0;    // of `frame_.rects`
    std::size_t before = 0;  // bytes of the rectangles before it
    int done = 0;            // of its rows
  };
  void advance(Rows& rows, int by) const;
  bool complete(const Rows& rows) const { return rows.rect == frame_.rects.size(); }

  FrameTask task_;
  Stage stage_ = Stage::prepare;
  std::vector<std::shared_ptr<const void>> layer_uses_;
  MeshProgress progress_;
  std::chrono::steady_clock::time_point mesh_begin_;  // when its first slice was drawn
  Frame frame_;
  PixelRect surface_;  // of the picture: may show surface
  Rows shaded_, collected_;
  gl::Readback pixels_;  // of one rectangle after the other, lowest row first
  double busy_ms_ = 0;
};

}  // namespace strata::render
