#pragma once

#include "gl/fence.h"
#include "render/edit/edit_kernel.h"
#include "render/edit/stroke_painter.h"

namespace strata::render {

// The depth in main memory, once a camera → the kernel says which texels are written → pages for
// tiles that have none → each tile is read where it holds something, changed, and uploaded whole.
// Once pages are had nothing can fail but the context.
class KernelPainter : public StrokePainter {
 public:
  using StrokePainter::StrokePainter;
  Result<Step> step(GpuScene& scene, const PaintTarget& target) override;

 private:
  enum class Stage { begin, depth_drawn, paint };
  KernelResult find_written(const PaintTarget& target);
  // One a written tile; kNoPage where an eraser finds nothing.
  Result<std::vector<PageId>> find_pages(const KernelResult& written, LayerTextures& layer) const;
  void write(const KernelResult& written, std::span<const PageId> pages, LayerTextures& layer);

  Stage stage_ = Stage::begin;
  gl::Fence drawn_;
};

}  // namespace strata::render
