#pragma once

#include <array>
#include <memory>
#include <span>

#include "gl/buffer.h"
#include "gl/texture.h"
#include "mesh/texels/surface_map.h"
#include "render/memory/gpu_memory.h"

namespace strata::render {

// A surface map on the GPU, uploaded in slices. It contains the packed positions, their boxes, and
// the block tree's parts with their culling spheres. The packed positions are slices of 2048 x 2048
// RG32UI texels, because some drivers limit a storage buffer to 128 MiB. Empty if edits are painted
// on the CPU.
class SurfaceMapTextures {
 public:
  static Result<std::unique_ptr<SurfaceMapTextures>> create(
      std::shared_ptr<const mesh::SurfaceMap> map, GpuMemory& memory);
  // Makes a map that is not uploaded to the GPU.
  static std::unique_ptr<SurfaceMapTextures> on_cpu(std::shared_ptr<const mesh::SurfaceMap> map);

  // Uploads the next few megabytes. Returns true when the upload is complete.
  bool upload_slice();
  bool complete() const {
    return !positions_ || (uploaded_rows_ == total_rows_ && next_buffer_ == buffers_.size());
  }
  const mesh::SurfaceMap& map() const { return *map_; }
  const gl::Texture& positions() const { return positions_; }
  const gl::Buffer& boxes() const { return buffers_[0].buffer; }  // one PackedBox for each slot
  // The block tree: center and radius of each node of 64 parts, center and radius of each part, and
  // the parts as EditPart.
  const gl::Buffer& nodes() const { return buffers_[1].buffer; }
  const gl::Buffer& spheres() const { return buffers_[2].buffer; }
  const gl::Buffer& parts() const { return buffers_[3].buffer; }
  const gl::Buffer& touched_parts() const {
    return touched_parts_;
  }  // room for one TouchedPart per part, for the current edit

 private:
  struct Filled {
    gl::Buffer buffer;
    std::span<const std::byte> content;  // data of the surface map
  };
  bool upload_buffers();
  void upload_rows();

  std::shared_ptr<const mesh::SurfaceMap> map_;
  gl::Texture positions_;
  std::array<Filled, 4> buffers_;
  gl::Buffer touched_parts_;
  GpuMemory::Share share_;
  std::size_t total_rows_ = 0;  // rows of 2048 texels
  std::size_t uploaded_rows_ = 0;
  std::size_t next_buffer_ = 0, uploaded_bytes_ = 0;  // the next buffer and its uploaded bytes
};

}  // namespace strata::render
