#pragma once

#include <memory>

#include "gl/texture.h"
#include "render/memory/gpu_memory.h"
#include "render/memory/mipmapped_picture.h"

namespace strata::render {

// A surface image on the GPU, uploaded in slices. Sampling interpolates between texels and between
// mipmap levels.
class SurfaceImageTexture {
 public:
  static Result<std::unique_ptr<SurfaceImageTexture>> create(
      std::shared_ptr<const MipmappedPicture> image, bool software, GpuMemory& memory);

  // Uploads the next few megabytes. Returns true when the upload is complete, and then releases the
  // image in main memory.
  bool upload_slice();
  const gl::Texture& texture() const { return texture_; }

 private:
  std::shared_ptr<const MipmappedPicture> image_;
  gl::Texture texture_;
  GpuMemory::Share share_;
  std::size_t level_ = 0;
  int row_ = 0;
};

}  // namespace strata::render
