#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/problem.h"
#include "core/tile.h"
#include "gl/texture.h"
#include "render/gpu_memory.h"

namespace strata::render {

using PageId = std::uint32_t;  // chunk, slice and cell: shaders/shared/pages.h

// Storage of tiles of one texel width, whatever layer they belong to: the paper's texture manager with pages instead of whole
// textures. Chunks are texture arrays of 2048 x 2048 slices of 16 x 16 pages, beside them a plane of valid flags; each
// chunk holds twice as many slices as the one before, and none is ever copied or moved.
class PagePool {
 public:
  PagePool(int texel_bytes, GpuMemory& memory) : texel_bytes_(texel_bytes), memory_(memory) {}

  int texel_bytes() const { return texel_bytes_; }
  std::uint64_t bytes_per_page() const { return std::uint64_t{kTexelsPerTile} * static_cast<unsigned>(texel_bytes_ + 1); }
  int chunk_count() const { return static_cast<int>(chunks_.size()); }
  const gl::Texture& values(int chunk) const { return chunks_[static_cast<std::size_t>(chunk)].values; }
  const gl::Texture& valid(int chunk) const { return chunks_[static_cast<std::size_t>(chunk)].valid; }

  // An empty page (no value, not valid). A Problem 503 when no chunk can be added.
  Result<PageId> allocate();
  void free(PageId page);
  // `data` is of this texel width.
  void upload(PageId page, const TileData& data);
  void clear(PageId page);

 private:
  struct Chunk {
    gl::Texture values, valid;
    GpuMemory::Share share;
  };
  Result<void> add_chunk();
  Result<void> add_chunk_of(int slices);

  const int texel_bytes_;
  GpuMemory& memory_;
  std::vector<Chunk> chunks_;
  std::vector<PageId> free_;  // the last one is taken first
};

// GL names of a texel width of 1, 2 or 4 bytes.
GLenum texel_format(int texel_bytes);
GLenum texel_component(int texel_bytes);
std::string image_format_define(int texel_bytes);  // "TEXEL_FORMAT r8ui"

}  // namespace strata::render
