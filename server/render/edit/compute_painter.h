#pragma once

#include <chrono>

#include "render/edit/stroke_painter.h"

namespace strata::render {

// Paints a stroke with compute passes. The steps are: compute the radii along the path; find the
// parts that the stroke may touch; dispatch the edit over them; read back the written texels; read
// back their tiles. After the dispatch only a lost context can cause an Error.
class ComputePainter : public StrokePainter {
 public:
  using StrokePainter::StrokePainter;
  Result<Step> step(GpuScene& scene, const PaintTarget& target) override;

 private:
  enum class Stage { begin, radii, culling, editing, tiles };
  Result<void> begin_radii(GpuScene& scene);
  void collect_radii(const mesh::Geometry& geometry);
  Result<void> cull(GpuScene& scene, const PaintTarget& target);
  Result<void> dispatch(GpuScene& scene, const PaintTarget& target);
  void collect_edited(GpuScene& scene, const PaintTarget& target);
  void begin_tiles(GpuScene& scene, const PaintTarget& target);
  void collect_tiles(const PaintTarget& target);

  Stage stage_ = Stage::begin;
  PathPixels path_pixels_;
  gl::Readback path_depths_;
  ToolPath path_;
  std::chrono::steady_clock::time_point begin_;
  gl::Readback touched_;
  DispatchedEdit edit_;
  std::size_t next_tile_ = 0;
  gl::Readback tiles_;                // allocated before the dispatch
  std::vector<std::size_t> reading_;  // indices into outcome_.tiles of the tiles in `tiles_`
};

}  // namespace strata::render
