#include "render/layer_textures.h"

#include "shared/pages.h"

namespace strata::render {

Result<std::unique_ptr<LayerTextures>> LayerTextures::create(ValueType type, int resolution, PageTables& tables,
                                                             PagePool& pool) {
  const int tiles = resolution / kTileSize;
  auto offset = tables.allocate(static_cast<std::uint32_t>(tiles * tiles));
  if (!offset) return tl::unexpected(offset.error());
  return std::unique_ptr<LayerTextures>(new LayerTextures(type, resolution, tables, pool, *offset));
}

LayerTextures::LayerTextures(ValueType type, int resolution, PageTables& tables, PagePool& pool,
                             std::uint32_t table_offset)
    : type_(type),
      resolution_(resolution),
      tiles_per_side_(resolution / kTileSize),
      tables_(tables),
      pool_(pool),
      table_offset_(table_offset),
      bytes_(std::make_shared<std::atomic<std::uint64_t>>(std::uint64_t{table_entries()} * sizeof(PageId))) {}

LayerTextures::~LayerTextures() {
  for (std::uint32_t i = 0; i < table_entries(); ++i) {
    if (const PageId page = tables_.at(table_offset_ + i); page != shader::kNoPage) pool_.free(page);
  }
  tables_.free(table_offset_, table_entries());
  *bytes_ = 0;
}

Result<PageId> LayerTextures::ensure_page(TileAddress tile) {
  if (const PageId present = page(tile); present != shader::kNoPage) return present;
  auto added = pool_.allocate();
  if (!added) return added;
  pool_.clear(*added);
  put_page(tile, *added);
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

}  // namespace strata::render
