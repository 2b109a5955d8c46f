#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "core/error.h"
#include "domain/layers/tile.h"
#include "gl/texture.h"
#include "render/memory/gpu_memory.h"

namespace strata::render {

using PageId = std::uint32_t;  // chunk, slice and cell (shaders/shared/pages.h)

// Stores the tiles of all layers with one texel width. It is the TEA paper's texture manager with
// pages instead of whole textures. A chunk is a texture array of 2048 x 2048 slices, each of 16 x
// 16 pages, with a second array for the valid flags. Each chunk has twice as many slices as the
// previous one. Chunks are never copied or moved. A chunk without used pages can be dropped to free
// its memory for other pools. A later chunk reuses its number.
class PagePool {
 public:
  PagePool(int texel_bytes, GpuMemory& memory) : texel_bytes_(texel_bytes), memory_(memory) {}

  int texel_bytes() const { return texel_bytes_; }
  std::uint64_t bytes_per_page() const {
    return std::uint64_t{kTexelsPerTile} * static_cast<unsigned>(texel_bytes_ + 1);
  }
  static constexpr std::size_t kMaxChunks = 16;  // shader::ShadeLayer has 4 bits for each chunk
  bool has_chunk(std::uint32_t chunk) const {
    return chunk < chunks_.size() && chunks_[chunk].values;
  }
  const gl::Texture& values(std::uint32_t chunk) const { return chunks_[chunk].values; }
  const gl::Texture& valid(std::uint32_t chunk) const { return chunks_[chunk].valid; }

  // Sets the function that frees pages of this pool. It returns false if all pages are in use. The
  // pool calls it before other memory is evicted.
  void set_evictor(std::function<bool()> free_some) { free_some_ = std::move(free_some); }

  // Allocates a page with undefined content. Returns the Error `out_of_memory` if no chunk can be
  // added.
  Result<PageId> allocate();
  void free(PageId page);
  // `data` must have the texel width of the pool.
  void upload(PageId page, const TileData& data);
  // Waits for the GPU, which is fast with a software renderer. Otherwise use TileReader.
  void read(PageId page, TileData& data) const;
  void clear(PageId page);  // sets all values and valid flags to 0
  // Frees the memory of one chunk without used pages. Returns false if there is no such chunk.
  bool drop_empty_chunk();

 private:
  // A chunk without textures is unused, and its number is free.
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
  std::vector<Chunk> chunks_;  // index: chunk number
  std::vector<PageId> free_;   // the last page is allocated first
};

}  // namespace strata::render
