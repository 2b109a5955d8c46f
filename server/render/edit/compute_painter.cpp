#include "render/edit/compute_painter.h"

#include "shared/pages.h"

namespace strata::render {

Result<Step> ComputePainter::step(GpuScene& scene, const PaintTarget& target) {
  const auto go_to = [this](Stage stage, Result<void> done) -> Result<Step> {
    if (!done) return tl::unexpected(done.error());
    stage_ = stage;
    return Step::more;
  };
  switch (stage_) {
    case Stage::begin: return go_to(Stage::radii, begin_radii(scene));
    case Stage::radii:
      if (!path_depths_.ready()) return Step::waiting;
      collect_radii(target.mesh.geometry());
      return go_to(Stage::culling, cull(scene, target));
    case Stage::culling:
      if (!touched_.ready()) return Step::waiting;
      return go_to(Stage::editing, dispatch(scene, target));
    case Stage::editing:
      if (!edit_.edited.ready()) return Step::waiting;
      collect_edited(scene, target);
      begin_tiles(scene, target);
      return go_to(Stage::tiles, {});
    case Stage::tiles:
      if (!tiles_.ready()) return Step::waiting;
      collect_tiles(target);
      if (next_tile_ == outcome_.tiles.size()) return Step::done;
      begin_tiles(scene, target);
      return Step::more;
  }
  return Step::done;
}

Result<void> ComputePainter::begin_radii(GpuScene& scene) {
  path_pixels_ = path_pixels();
  if (path_pixels_.pixels.empty()) return {};
  auto depths = STRATA_TRY(scene.depths().begin_gather(*depth_, path_pixels_.pixels));
  path_depths_ = std::move(depths);
  return {};
}

void ComputePainter::collect_radii(const mesh::Geometry& geometry) {
  std::vector<float> depths;
  if (path_depths_) depths = DepthBuffers::finish_gather(path_depths_);
  path_depths_ = {};
  path_ = make_path(geometry, path_pixels_, depths);
}

Result<void> ComputePainter::cull(GpuScene& scene, const PaintTarget& target) {
  begin_ = std::chrono::steady_clock::now();
  if (!stroke_.through) {
    STRATA_TRY(scene.depths().make_grid(*depth_));
  }
  const mesh::Geometry& geometry = target.mesh.geometry();
  auto touched = scene.edit_culler().dispatch(stroke_, geometry.origin, path_, depth_bias(geometry),
                                              target.map, stroke_.through ? nullptr : &depth_->grid,
                                              target.layer);
  if (!touched) return tl::unexpected(touched.error());
  touched_ = std::move(*touched);
  return {};
}

Result<void> ComputePainter::dispatch(GpuScene& scene, const PaintTarget& target) {
  auto touched = EditCuller::touched(touched_, target.map.map().resolution);
  outcome_.bytes_up = scene.edit_culler().bytes_up();
  outcome_.bytes_down = touched_.size();
  touched_ = {};
  if (!touched.tiles.empty()) {
    auto room =
        STRATA_TRY(scene.tile_reader().make_room(target.layer.pool(), touched.tiles.size()));
    tiles_ = std::move(room);
  }
  auto edit =
      scene.edit_pass().dispatch(stroke_, std::move(touched), scene.edit_culler(), target.map,
                                 depth_ ? &depth_->texture : nullptr, target.layer, scene.tables());
  if (!edit) return tl::unexpected(edit.error());
  edit_ = std::move(*edit);
  outcome_.bytes_up += edit_.fresh_tiles.size() * sizeof(PageId);
  outcome_.bytes_down += edit_.edited.size();
  return {};
}

void ComputePainter::collect_edited(GpuScene& scene, const PaintTarget& target) {
  const EditedTiles edited = EditPass::edited(edit_);
  outcome_.edit_ms =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin_).count();
  outcome_.gpu_ms = scene.edit_culler().gpu_ms() + (edit_.edited ? scene.edit_pass().gpu_ms() : 0);
  for (const TileAddress tile : edit_.fresh_tiles) {
    if (!edited.masks.contains(tile)) target.layer.free_page(tile);
  }
  outcome_.written_min = edited.written_min;
  outcome_.written_max = edited.written_max;
  for (const auto& [tile, mask] : edited.masks)
    outcome_.tiles.push_back({tile, mask, TileData(target.layer.type())});
  edit_ = {};
}

void ComputePainter::begin_tiles(GpuScene& scene, const PaintTarget& target) {
  std::vector<PageId> pages;
  reading_.clear();
  while (next_tile_ < outcome_.tiles.size() && pages.size() < TileReader::kMaxPages) {
    const PageId page = target.layer.page(outcome_.tiles[next_tile_].address);
    // Without a page there is nothing to erase, so the tile stays empty.
    if (page != shader::kNoPage) {
      pages.push_back(page);
      reading_.push_back(next_tile_);
    }
    ++next_tile_;
  }
  if (!pages.empty()) scene.tile_reader().begin(target.layer.pool(), pages, tiles_);
  outcome_.bytes_down += pages.size() * TileReader::bytes_per_tile(target.layer.pool());
}

void ComputePainter::collect_tiles(const PaintTarget& target) {
  for (std::size_t i = 0; i < reading_.size(); ++i) {
    WrittenTile& tile = outcome_.tiles[reading_[i]];
    tile.after = TileReader::tile(tiles_, target.layer.pool(), i);
    if (!tile.after.valid.any()) target.layer.free_page(tile.address);
  }
  reading_.clear();
}

}  // namespace strata::render
