#pragma once

#include <memory>

#include "gl/buffer.h"
#include "gl/texture.h"
#include "mesh/surface_map.h"
#include "render/gpu_memory.h"

namespace strata::render {

// A surface map's packed positions on the GPU: 2048 x 2048 slices of RG32UI (a storage buffer would end at 128 MiB on some
// drivers) and the boxes they are packed in, filled in slices. The block table and the bounds stay on the CPU, where edits are culled;
// all of it does where they are painted there, too.
class SurfaceMapTextures {
 public:
  static Result<std::unique_ptr<SurfaceMapTextures>> create(std::shared_ptr<const mesh::SurfaceMap> map,
                                                            GpuMemory& memory);
  // Nothing of it on the GPU.
  static std::unique_ptr<SurfaceMapTextures> on_cpu(std::shared_ptr<const mesh::SurfaceMap> map);

  // Uploads the next few megabytes; true when everything is there.
  bool upload_slice();
  bool complete() const {
    return !positions_ || (uploaded_rows_ == total_rows_ && uploaded_boxes_ == map_->packed_box.size());
  }
  const mesh::SurfaceMap& map() const { return *map_; }
  const gl::Texture& positions() const { return positions_; }
  const gl::Buffer& boxes() const { return boxes_; }

 private:
  std::shared_ptr<const mesh::SurfaceMap> map_;
  gl::Texture positions_;
  gl::Buffer boxes_;
  GpuMemory::Share share_;
  std::size_t total_rows_ = 0;  // of 2048 texels
  std::size_t uploaded_rows_ = 0;
  std::size_t uploaded_boxes_ = 0;
};

}  // namespace strata::render
