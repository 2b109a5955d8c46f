#pragma once

#include "render/gpu_scene.h"
#include "render/gpu_thread.h"

namespace strata::render {

// One stroke batch: depth of the mesh where no view has it → radii under the path → the depth grid that culls → the
// dispatch → the rows it wrote → the tiles it wrote. After the dispatch nothing can fail but the context: a refused
// stroke has painted nothing.
class PaintJob {
 public:
  PaintJob(LayerHandle layer, StrokeBatch stroke, Renderer::Done<StrokeOutcome> done)
      : layer_(layer), stroke_(std::move(stroke)), done_(std::move(done)) {}

  Step step(GpuScene& scene);
  void abort(const Problem& problem) { done_(tl::unexpected(problem)); }

 private:
  enum class Stage { begin, depth, radii, grid, dispatch, rows, tiles };
  struct Target {
    const MeshBuffers& mesh;
    const SurfaceMapTextures& map;
    LayerTextures& layer;
  };
  Result<Target> target(GpuScene& scene);
  Result<Step> advance(GpuScene& scene, const Target& target);
  Result<void> find_depth(GpuScene& scene);
  Result<void> begin_radii(GpuScene& scene);
  void collect_radii(const mesh::Geometry& geometry);
  Result<void> begin_grid(GpuScene& scene);
  Result<void> dispatch(GpuScene& scene, const Target& target);
  void collect_rows(GpuScene& scene, const Target& target);
  void begin_tiles(GpuScene& scene, const Target& target);
  void collect_tiles(const Target& target);
  void finish(GpuScene& scene);
  glm::dmat4 clip_from_model(const mesh::Geometry& geometry) const;

  const LayerHandle layer_;
  const StrokeBatch stroke_;
  Renderer::Done<StrokeOutcome> done_;
  Stage stage_ = Stage::begin;
  std::shared_ptr<DepthBuffer> depth_;  // null where nothing asks for it
  MeshProgress drawn_;
  gl::Readback path_depths_;
  std::vector<std::size_t> in_window_;  // path points that `path_depths_` is of
  ToolPath path_;
  DepthBuffers::GridRead grid_;
  DispatchedEdit edit_;
  StrokeOutcome outcome_;
  std::size_t next_tile_ = 0;
  gl::Readback tiles_;                // made before the dispatch
  std::vector<std::size_t> reading_;  // indices into outcome_.tiles of what `tiles_` brings
};

// Bad paths, radii and cameras, before any GPU work.
Result<void> validate(const StrokeBatch& stroke);

}  // namespace strata::render
