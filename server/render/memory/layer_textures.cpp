#include "render/memory/layer_textures.h"

#include <numeric>

#include "shared/pages.h"

namespace strata::render {

Result<std::unique_ptr<LayerTextures>> LayerTextures::create(ValueType type, int resolution,
                                                             PageTables& tables, PagePool& pool) {
  const int tiles = resolution / kTileSize;
  auto offset = STRATA_TRY(tables.allocate(static_cast<std::uint32_t>(tiles * tiles)));
  return std::unique_ptr<LayerTextures>(new LayerTextures(type, resolution, tables, pool, offset));
}

LayerTextures::LayerTextures(ValueType type, int resolution, PageTables& tables, PagePool& pool,
                             std::uint32_t table_offset)
    : type_(type),
      resolution_(resolution),
      tiles_per_side_(resolution / kTileSize),
      tables_(tables),
      pool_(pool),
      table_offset_(table_offset),
      bytes_(std::make_shared<std::atomic<std::uint64_t>>(std::uint64_t{table_entries()} *
                                                          sizeof(PageId))) {}

LayerTextures::~LayerTextures() {
  free_pages();
  tables_.free(table_offset_, table_entries());
  *bytes_ = 0;
}

Result<PageId> LayerTextures::ensure_page(TileAddress tile) {
  if (const PageId present = page(tile); present != shader::kNoPage) return present;
  auto added = STRATA_TRY(pool_.allocate());
  pool_.clear(added);
  put_page(tile, added);
  return added;
}

void LayerTextures::put_page(TileAddress tile, PageId page) {
  tables_.set(index(tile), page);
  ++pages_in_chunk_[page >> shader::kPageChunkShift];
  *bytes_ += pool_.bytes_per_page();
}

void LayerTextures::free_page(TileAddress tile) {
  const PageId present = page(tile);
  if (present == shader::kNoPage) return;
  pool_.free(present);
  --pages_in_chunk_[present >> shader::kPageChunkShift];
  tables_.set(index(tile), shader::kNoPage);
  *bytes_ -= pool_.bytes_per_page();
}

void LayerTextures::free_pages() {
  for (int y = 0; y < tiles_per_side_; ++y)
    for (int x = 0; x < tiles_per_side_; ++x)
      free_page({static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y)});
}

std::size_t LayerTextures::page_count() const {
  return std::accumulate(pages_in_chunk_.begin(), pages_in_chunk_.end(), std::size_t{0});
}

}  // namespace strata::render
