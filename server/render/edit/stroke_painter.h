#pragma once

#include "render/thread/gpu_scene.h"
#include "render/thread/gpu_thread.h"

namespace strata::render {

// The target of a stroke; looked up again for each step, because a layer may be removed between two
// steps.
struct PaintTarget {
  const MeshBuffers& mesh;
  const SurfaceMapTextures& map;
  LayerTextures& layer;
};

// Paints one stroke batch after the depth of the full mesh is complete. There are two:
// ComputePainter on the GPU, and KernelPainter on the CPU, used if the "GPU" is one
// (GpuScene::edits_on_cpu). They write the same surface texels except for rounding.
class StrokePainter {
 public:
  // `depth` is null if the stroke does not need it.
  StrokePainter(const StrokeBatch& stroke, std::shared_ptr<DepthBuffer> depth)
      : stroke_(stroke), depth_(std::move(depth)) {}
  StrokePainter(const StrokePainter&) = delete;
  StrokePainter& operator=(const StrokePainter&) = delete;
  virtual ~StrokePainter() = default;

  // Works for a few milliseconds. After an Error nothing is painted.
  virtual Result<Step> step(GpuScene& scene, const PaintTarget& target) = 0;
  StrokeOutcome take_outcome() { return std::move(outcome_); }  // when done

 protected:
  // Points of the path at which a radius in model units needs the depth: those inside the window.
  // Origin lower left.
  struct PathPixels {
    std::vector<glm::ivec2> pixels;
    std::vector<std::size_t> points;
  };
  PathPixels path_pixels() const;
  // `depths` has one entry for each pixel of `at`.
  ToolPath make_path(const mesh::Geometry& geometry, const PathPixels& at,
                     std::span<const float> depths) const;
  DepthBias depth_bias(const mesh::Geometry& geometry) const;
  glm::dmat4 clip_from_model(const mesh::Geometry& geometry) const;

  const StrokeBatch& stroke_;
  std::shared_ptr<DepthBuffer> depth_;
  StrokeOutcome outcome_;
};

}  // namespace strata::render
