#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "core/error.h"
#include "domain/layers/tile.h"
#include "gl/texture.h"
#include "render/memory/gpu_memory.h"

namespace strata::render {

using PageId = std::uint32_t;  // chunk, slice and cell: shaders/shared/pages.h

// Storage of tiles of one texel width, for all layers: the paper's texture manager with pages
// instead of whole textures. Chunks are texture arrays of 2048 x 2048 slices of 16 x 16 pages, each
// with a second array of valid flags. Each chunk has twice as many slices as the one before, and no
// chunk is ever copied or moved. A chunk without pages can be dropped, so that other pools can use
// its memory; a later chunk reuses its number.
class PagePool {
 public:
  PagePool(int texel_bytes, GpuMemory& memory) : texel_bytes_(texel_bytes), memory_(memory) {}

  int texel_bytes() const { return texel_bytes_; }
  std::uint64_t bytes_per_page() const {
    return std::uint64_t{kTexelsPerTile} * static_cast<unsigned>(texel_bytes_ + 1);
  }
  static constexpr std::size_t kMaxChunks = 16;  // 4 bits in a shade layer's units
  bool has_chunk(std::uint32_t chunk) const {
    return chunk < chunks_.size() && chunks_[chunk].values;
  }
  const gl::Texture& values(std::uint32_t chunk) const { return chunks_[chunk].values; }
  const gl::Texture& valid(std::uint32_t chunk) const { return chunks_[chunk].valid; }

  // Frees pages of this pool that are not in use; returns false if all are in use. Called before
  // other memory is evicted.
  void set_evictor(std::function<bool()> free_some) { free_some_ = std::move(free_some); }

  // Allocates a page with undefined content. An Error `out_of_memory` if no chunk can be added.
  Result<PageId> allocate();
  void free(PageId page);
  // `data` must be of this texel width.
  void upload(PageId page, const TileData& data);
  // Waits for the GPU: fast if the GPU is a CPU, otherwise use TileReader.
  void read(PageId page, TileData& data) const;
  void clear(PageId page);  // no value, not valid
  // Frees the memory of one chunk without pages; false if there is no such chunk.
  bool drop_empty_chunk();

 private:
  // without textures: the number is free
  struct Chunk {
    gl::Texture values, valid;
    GpuMemory::Share share;
    std::uint32_t used_pages = 0;
  };
  std::uint64_t chunk_bytes(int slices) const;
  Result<void> add_chunk();
  Result<Chunk> make_chunk(std::size_t number, int slices);

  const int texel_bytes_;
  GpuMemory& memory_;
  std::function<bool()> free_some_;
  std::vector<Chunk> chunks_;  // by number
  std::vector<PageId> free_;   // the last one is taken first
};

}  // namespace strata::render
