#pragma once

#include "render/edit/stroke_painter.h"

namespace strata::render {

// Paints one stroke batch. Uploads the layer if it was evicted, draws the depth of the mesh if no
// view has it, and then runs the StrokePainter. A rejected stroke changes no texel.
class PaintJob {
 public:
  PaintJob(LayerHandle layer, StrokeBatch stroke, Renderer::Done<StrokeOutcome> done)
      : layer_(layer), stroke_(std::move(stroke)), done_(std::move(done)) {}

  Step step(GpuScene& scene);
  void abort(const Error& problem) { done_(tl::unexpected(problem)); }

 private:
  enum class Stage { layer, begin, depth, painting };
  Result<PaintTarget> target(GpuScene& scene);
  Result<Step> advance(GpuScene& scene, const PaintTarget& target);
  Result<void> begin(GpuScene& scene, const PaintTarget& target);
  Result<void> find_depth(GpuScene& scene);
  void finish(GpuScene& scene);

  const LayerHandle layer_;
  StrokeBatch stroke_;
  Renderer::Done<StrokeOutcome> done_;
  Stage stage_ = Stage::layer;
  std::shared_ptr<const void> layer_use_;
  std::shared_ptr<DepthBuffer> depth_;  // null if the stroke does not need it
  MeshProgress drawn_;
  std::unique_ptr<StrokePainter> painter_;
};

// Rejects strokes with invalid values, for example paths, radii or cameras, before any GPU work.
Result<void> validate(const StrokeBatch& stroke);

}  // namespace strata::render
