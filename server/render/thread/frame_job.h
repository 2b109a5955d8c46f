#pragma once

#include <chrono>
#include <memory>
#include <optional>

#include "gl/fence.h"
#include "render/thread/frame_queue.h"
#include "render/thread/gpu_scene.h"
#include "render/thread/gpu_thread.h"

namespace strata::render {

// One frame, drawn by one view. If the camera changed, the g-buffer is drawn in slices. Then the
// changed parts are shaded and read back in bands. A frame with several samples repeats drawing and
// shading for each sample, in separate buffers, and reads back the mean. A frame with smooth edges
// is the mean of the view's frame and of such samples. If the view has lost its buffers, a partial
// frame draws the mesh only in the part around its rectangles, in buffers that views share.
class FrameJob {
 public:
  explicit FrameJob(FrameTask task) : task_(std::move(task)) {}

  const FrameTask& task() const { return task_; }
  double busy_ms() const { return busy_ms_; }
  bool is_drawn() const { return is_drawn_; }  // the requesters have got the frame
  // The frame's turn, with the current served time of its requester.
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
  enum class Stage { prepare, layers, gbuffer, area, shade, mean, readback };
  // The picture has its own buffers, so the view's frame stays unchanged.
  bool is_separate() const { return task_.request.samples > 1; }
  Result<View*> buffers(GpuScene& scene) const;
  bool is_part_of_last(const View& view, const DepthKey& key) const;
  Result<void> start_part(GpuScene& scene, const View& view, const DepthKey& key);
  std::vector<PixelRect> changed_rects(const mesh::Geometry& geometry, const View& view) const;
  Result<const FeatureBuffer*> features(GpuScene& scene, const View& view) const;
  void release_view(GpuScene& scene, bool is_complete);
  Result<void> start_samples(GpuScene& scene, ModelHandle model);
  void make_smooth(GpuScene& scene, const View& view);
  bool has_layers(GpuScene& scene) const;  // true if all layers are on the GPU
  Result<void> start_sample(GpuScene& scene, ModelHandle model);
  Result<bool> add_sample(GpuScene& scene, const View& view);  // true after the last sample
  void measure(GpuScene& scene);
  Result<void> prepare(GpuScene& scene, View& view);
  Result<bool> bring_layers(GpuScene& scene);  // true when all layers are on the GPU
  Result<int> choose_level(GpuScene& scene, const View& view) const;
  Result<bool> draw_slice(GpuScene& scene, View& view);  // true when complete
  Result<void> choose_area(GpuScene& scene, View& view);
  Result<void> test_features(GpuScene& scene, View& view) const;
  Result<bool> shade_band(GpuScene& scene, View& view);  // true when complete
  bool read_mean();                                      // true when complete
  void read_band(const gl::Texture& picture, const PixelRect& band);
  bool collect_rows();  // true when complete

  // The progress of a loop over the rows of all rectangles, each from its top row.
  struct Rows {
    std::size_t rect = 0;    // index in `frame_.rects`
    std::size_t before = 0;  // bytes of the earlier rectangles
    int done = 0;            // completed rows of this rectangle
  };
  void advance(Rows& rows, int by) const;
  bool complete(const Rows& rows) const { return rows.rect == frame_.rects.size(); }

  FrameTask task_;
  Camera camera_;  // camera of the frame, or of the current sample
  // The buffers of a partial frame whose view has none, and the part in which the mesh is drawn.
  // The rest of the buffers has the content of another view.
  std::unique_ptr<View> shared_view_;
  PixelRect part_;
  // The state of a frame with several samples.
  std::unique_ptr<View> sample_view_;
  std::optional<Accumulation> mean_;
  int samples_ = 1, sample_ = 0, level_ = 0;
  std::size_t own_triangles_ = 0;  // of the view's frame
  // The time at which the view's frame was drawn and the other samples began.
  std::optional<std::chrono::steady_clock::time_point> samples_begin_;
  double samples_begin_ms_ = 0;  // `busy_ms_` before the first sample
  gl::Fence sample_drawn_;       // ensures that an edit waits for at most one sample
  Stage stage_ = Stage::prepare;
  std::vector<std::shared_ptr<const void>> layer_uses_;
  MeshProgress progress_;
  std::chrono::steady_clock::time_point mesh_begin_;  // time of the first slice
  Frame frame_;
  PixelRect surface_;  // the part of the frame that may show the surface
  PixelRect shadow_;   // the part of the frame that may show the contact shadow
  Rows shaded_, collected_;
  gl::Readback pixels_;  // one rectangle after another, lowest row first
  double busy_ms_ = 0;
  bool is_drawn_ = false;
};

}  // namespace strata::render
