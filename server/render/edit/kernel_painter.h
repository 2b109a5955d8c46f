#pragma once

#include "gl/fence.h"
#include "render/edit/edit_kernel.h"
#include "render/edit/stroke_painter.h"

namespace strata::render {

// Paints a stroke on the CPU. The steps are: copy the depth to main memory, once for each camera;
// compute the written texels with the kernel; allocate missing pages; read, change and upload each
// written tile. After the pages are allocated, only a lost context can cause an Error.
class KernelPainter : public StrokePainter {
 public:
  using StrokePainter::StrokePainter;
  Result<Step> step(GpuScene& scene, const PaintTarget& target) override;

 private:
  enum class Stage { begin, depth_drawn, paint };
  KernelResult find_written(const PaintTarget& target);
  // Returns one page for each written tile: kNoPage for a tile without a page if the stroke erases.
  Result<std::vector<PageId>> find_pages(const KernelResult& written, LayerTextures& layer) const;
  void write(const KernelResult& written, std::span<const PageId> pages, LayerTextures& layer);

  Stage stage_ = Stage::begin;
  gl::Fence drawn_;
};

}  // namespace strata::render
