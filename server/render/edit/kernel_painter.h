#pragma once

#include "gl/fence.h"
#include "render/edit/edit_kernel.h"
#include "render/edit/stroke_painter.h"

namespace strata::render {

// Steps: copy the depth to main memory, once for each camera; find the written texels with the
// kernel; allocate missing pages; read each tile that has content, change it, and upload it whole.
// After the allocation of pages only a lost context is an error.
class KernelPainter : public StrokePainter {
 public:
  using StrokePainter::StrokePainter;
  Result<Step> step(GpuScene& scene, const PaintTarget& target) override;

 private:
  enum class Stage { begin, depth_drawn, paint };
  KernelResult find_written(const PaintTarget& target);
  // One for each written tile; kNoPage where an eraser finds no page.
  Result<std::vector<PageId>> find_pages(const KernelResult& written, LayerTextures& layer) const;
  void write(const KernelResult& written, std::span<const PageId> pages, LayerTextures& layer);

  Stage stage_ = Stage::begin;
  gl::Fence drawn_;
};

}  // namespace strata::render
