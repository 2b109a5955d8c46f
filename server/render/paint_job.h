#pragma once

#include "render/gpu_scene.h"
#include "render/gpu_thread.h"

namespace strata::render {

// One stroke batch, from culling to the tiles it wrote: dispatch → read the written rows → read the written tiles.
class PaintJob {
 public:
  PaintJob(LayerHandle layer, StrokeBatch stroke, Renderer::Done<StrokeOutcome> done)
      : layer_(layer), stroke_(std::move(stroke)), done_(std::move(done)) {}

  Step step(GpuScene& scene);
  void abort(const Problem& problem) { done_(tl::unexpected(problem)); }

 private:
  enum class Stage { dispatch, rows, tiles };
  Result<void> dispatch(GpuScene& scene, GpuScene::Layer& layer);
  Result<std::vector<double>> radii(GpuScene& scene, const DepthBuffer* depth, const glm::dmat4& clip_from_model,
                                    const mesh::Geometry& geometry);
  void collect_rows(GpuScene& scene, GpuScene::Layer& layer);
  Result<void> begin_tiles(GpuScene& scene, GpuScene::Layer& layer);
  void collect_tiles(GpuScene::Layer& layer);
  void finish(GpuScene& scene);

  const LayerHandle layer_;
  const StrokeBatch stroke_;
  Renderer::Done<StrokeOutcome> done_;
  Stage stage_ = Stage::dispatch;
  DispatchedEdit edit_;
  StrokeOutcome outcome_;
  std::size_t next_tile_ = 0;
  gl::Readback tiles_;
  std::vector<std::size_t> reading_;  // indices into outcome_.tiles of what `tiles_` brings
};

// Bad paths, radii and cameras, before any GPU work.
Result<void> validate(const StrokeBatch& stroke);

}  // namespace strata::render
