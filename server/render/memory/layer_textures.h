#pragma once

#include <array>
#include <atomic>
#include <memory>

#include "domain/layers/tile.h"
#include "render/memory/page_pool.h"
#include "render/memory/page_tables.h"

namespace strata::render {

// One layer on the GPU: its range of the page tables, and its pages in the pool of its texel width.
// An empty layer uses 4 bytes per tile. GPU thread only, except `bytes`.
class LayerTextures {
 public:
  static Result<std::unique_ptr<LayerTextures>> create(ValueType type, int resolution,
                                                       PageTables& tables, PagePool& pool);
  ~LayerTextures();  // frees all pages
  LayerTextures(const LayerTextures&) = delete;
  LayerTextures& operator=(const LayerTextures&) = delete;

  ValueType type() const { return type_; }
  int resolution() const { return resolution_; }
  PagePool& pool() const { return pool_; }
  std::uint32_t table_offset() const { return table_offset_; }
  bool has_page_in(std::uint32_t chunk) const { return pages_in_chunk_[chunk] > 0; }

  std::size_t page_count() const;
  bool contains(TileAddress tile) const {
    return tile.x < tiles_per_side_ && tile.y < tiles_per_side_;
  }
  // Returns kNoPage if the tile is empty.
  PageId page(TileAddress tile) const { return tables_.at(index(tile)); }
  // Returns the tile's page. If the tile has no page, adds an empty page.
  Result<PageId> ensure_page(TileAddress tile);
  // Assigns a page of the pool to a tile without a page.
  void put_page(TileAddress tile, PageId page);
  void free_page(TileAddress tile);
  void free_pages();  // frees the pages of all tiles

  // Returns the bytes of the table and the pages. The counter outlives the layer, so any thread may
  // read it.
  const std::shared_ptr<std::atomic<std::uint64_t>>& bytes() const { return bytes_; }

 private:
  LayerTextures(ValueType type, int resolution, PageTables& tables, PagePool& pool,
                std::uint32_t table_offset);
  std::uint32_t index(TileAddress t) const {
    return table_offset_ + t.y * static_cast<std::uint32_t>(tiles_per_side_) + t.x;
  }
  std::uint32_t table_entries() const {
    return static_cast<std::uint32_t>(tiles_per_side_ * tiles_per_side_);
  }

  const ValueType type_;
  const int resolution_, tiles_per_side_;
  PageTables& tables_;
  PagePool& pool_;
  const std::uint32_t table_offset_;
  std::array<std::uint32_t, PagePool::kMaxChunks> pages_in_chunk_{};
  std::shared_ptr<std::atomic<std::uint64_t>> bytes_;
};

}  // namespace strata::render
