#pragma once

#include "render/thread/gpu_scene.h"
#include "render/thread/gpu_thread.h"

namespace strata::render {

// What a stroke is painted on; looked up anew for each step, because a layer may be removed between
// two.
struct PaintTarget {
  const MeshBuffers& mesh;
  const SurfaceMapTextures& map;
  LayerTextures& layer;
};

// Paints one stroke batch once the depth of the full mesh is there. Two of them: ComputePainter on
// the GPU, KernelPainter on the CPU, where the "GPU" is one (GpuScene::edits_on_cpu). They write
// the same surface texels but for rounding.
class StrokePainter {
 public:
  // `depth` is null where nothing asks for it.
  StrokePainter(const StrokeBatch& stroke, std::shared_ptr<DepthBuffer> depth)
      : stroke_(stroke), depth_(std::move(depth)) {}
  StrokePainter(const StrokePainter&) = delete;
  StrokePainter& operator=(const StrokePainter&) = delete;
  virtual ~StrokePainter() = default;

  // The next few milliseconds. An Error has painted nothing.
  virtual Result<Step> step(GpuScene& scene, const PaintTarget& target) = 0;
  StrokeOutcome take_outcome() { return std::move(outcome_); }  // once done

 protected:
  // Points of the path whose depth a radius in model units needs: those inside the window. Origin
  // lower left.
  struct PathPixels {
    std::vector<glm::ivec2> pixels;
    std::vector<std::size_t> points;
  };
  PathPixels path_pixels() const;
  // `depths` is one a pixel of `at`.
  ToolPath make_path(const mesh::Geometry& geometry, const PathPixels& at,
                     std::span<const float> depths) const;
  DepthBias depth_bias(const mesh::Geometry& geometry) const;
  glm::dmat4 clip_from_model(const mesh::Geometry& geometry) const;

  const StrokeBatch& stroke_;
  std::shared_ptr<DepthBuffer> depth_;
  StrokeOutcome outcome_;
};

}  // namespace strata::render
