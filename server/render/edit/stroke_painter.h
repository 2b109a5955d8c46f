#pragma once

#include "render/thread/gpu_scene.h"
#include "render/thread/gpu_thread.h"

namespace strata::render {

// The target of a stroke. It is looked up again for each step, because a layer may be removed
// between two steps.
struct PaintTarget {
  const MeshBuffers& mesh;
  const SurfaceMapTextures& map;
  LayerTextures& layer;
};

// Paints one stroke batch after the depth of the full mesh is complete. ComputePainter paints on
// the GPU. KernelPainter paints on the CPU and is used with software renderers
// (GpuScene::edits_on_cpu). Both write the same surface texels except for rounding.
class StrokePainter {
 public:
  // `depth` is null if the stroke does not need it.
  StrokePainter(const StrokeBatch& stroke, std::shared_ptr<DepthBuffer> depth)
      : stroke_(stroke), depth_(std::move(depth)) {}
  StrokePainter(const StrokePainter&) = delete;
  StrokePainter& operator=(const StrokePainter&) = delete;
  virtual ~StrokePainter() = default;

  // Runs for a few milliseconds. If it fails, nothing is painted.
  virtual Result<Step> step(GpuScene& scene, const PaintTarget& target) = 0;
  StrokeOutcome take_outcome() { return std::move(outcome_); }  // after the last step

 protected:
  // The points of the path inside the window and their pixels, origin lower left. A radius in model
  // units depends on the depth at these pixels.
  struct PathPixels {
    std::vector<glm::ivec2> pixels;
    std::vector<std::size_t> points;
  };
  PathPixels path_pixels() const;
  // `depths` contains one depth for each pixel of `at`.
  ToolPath make_path(const mesh::Geometry& geometry, const PathPixels& at,
                     std::span<const float> depths) const;
  DepthBias depth_bias(const mesh::Geometry& geometry) const;
  glm::dmat4 clip_from_model(const mesh::Geometry& geometry) const;

  const StrokeBatch& stroke_;
  std::shared_ptr<DepthBuffer> depth_;
  StrokeOutcome outcome_;
};

}  // namespace strata::render
