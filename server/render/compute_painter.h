#pragma once

#include "render/stroke_painter.h"

namespace strata::render {

// Radii under the path → the depth grid that culls → the dispatch → the rows it wrote → the tiles it wrote. After the
// dispatch nothing can fail but the context.
class ComputePainter : public StrokePainter {
 public:
  using StrokePainter::StrokePainter;
  Result<Step> step(GpuScene& scene, const PaintTarget& target) override;

 private:
  enum class Stage { begin, radii, grid, rows, tiles };
  Result<void> begin_radii(GpuScene& scene);
  void collect_radii(const mesh::Geometry& geometry);
  Result<void> begin_grid(GpuScene& scene);
  Result<void> dispatch(GpuScene& scene, const PaintTarget& target);
  void collect_rows(GpuScene& scene, const PaintTarget& target);
  void begin_tiles(GpuScene& scene, const PaintTarget& target);
  void collect_tiles(const PaintTarget& target);

  Stage stage_ = Stage::begin;
  PathPixels path_pixels_;
  gl::Readback path_depths_;
  ToolPath path_;
  DepthBuffers::GridRead grid_;
  DispatchedEdit edit_;
  std::size_t next_tile_ = 0;
  gl::Readback tiles_;                // made before the dispatch
  std::vector<std::size_t> reading_;  // indices into outcome_.tiles of what `tiles_` brings
};

}  // namespace strata::render
