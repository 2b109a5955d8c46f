#pragma once

#include <array>
#include <memory>
#include <span>

#include "gl/buffer.h"
#include "gl/texture.h"
#include "mesh/texels/surface_map.h"
#include "render/memory/gpu_memory.h"

namespace strata::render {

// A surface map on the GPU, uploaded in slices: packed positions as 2048 x 2048 slices of RG32UI (a
// storage buffer would be limited to 128 MiB on some drivers), the boxes of the packed positions,
// and the block tree's parts with their culling spheres. Empty if edits are painted on the CPU.
class SurfaceMapTextures {
 public:
  static Result<std::unique_ptr<SurfaceMapTextures>> create(
      std::shared_ptr<const mesh::SurfaceMap> map, GpuMemory& memory);
  // Uploads nothing to the GPU.
  static std::unique_ptr<SurfaceMapTextures> on_cpu(std::shared_ptr<const mesh::SurfaceMap> map);

  // Uploads the next few megabytes; true when complete.
  bool upload_slice();
  bool complete() const {
    return !positions_ || (uploaded_rows_ == total_rows_ && next_buffer_ == buffers_.size());
  }
  const mesh::SurfaceMap& map() const { return *map_; }
  const gl::Texture& positions() const { return positions_; }
  const gl::Buffer& boxes() const { return buffers_[0].buffer; }  // a slot: PackedBox
  // For the tree: center and radius of each node of 64 parts and of each part, and the parts as
  // EditPart.
  const gl::Buffer& nodes() const { return buffers_[1].buffer; }
  const gl::Buffer& spheres() const { return buffers_[2].buffer; }
  const gl::Buffer& parts() const { return buffers_[3].buffer; }
  const gl::Buffer& touched_parts() const {
    return touched_parts_;
  }  // a TouchedPart for each part, for the current edit

 private:
  struct Filled {
    gl::Buffer buffer;
    std::span<const std::byte> content;  // of the map
  };
  bool upload_buffers();
  void upload_rows();

  std::shared_ptr<const mesh::SurfaceMap> map_;
  gl::Texture positions_;
  std::array<Filled, 4> buffers_;
  gl::Buffer touched_parts_;
  GpuMemory::Share share_;
  std::size_t total_rows_ = 0;  // of 2048 texels
  std::size_t uploaded_rows_ = 0;
  std::size_t next_buffer_ = 0, uploaded_bytes_ = 0;  // the latter of that buffer
};

}  // namespace strata::render
