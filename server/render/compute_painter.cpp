#include "render/compute_painter.h"

#include <algorithm>
#include <chrono>
#include <limits>

#include "mesh/parallel.h"
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
      return go_to(Stage::grid, begin_grid(scene));
    case Stage::grid:
      if (!grid_.values.ready()) return Step::waiting;
      if (depth_) DepthBuffers::finish_grid(*depth_, grid_);
      return go_to(Stage::rows, dispatch(scene, target));
    case Stage::rows:
      if (!edit_.rows.ready()) return Step::waiting;
      collect_rows(scene, target);
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
  auto depths = scene.depths().begin_gather(*depth_, path_pixels_.pixels);
  if (!depths) return tl::unexpected(depths.error());
  path_depths_ = std::move(*depths);
  return {};
}

void ComputePainter::collect_radii(const mesh::Geometry& geometry) {
  std::vector<float> depths;
  if (path_depths_) depths = DepthBuffers::finish_gather(path_depths_);
  path_depths_ = {};
  path_ = make_path(geometry, path_pixels_, depths);
}

Result<void> ComputePainter::begin_grid(GpuScene& scene) {
  if (stroke_.through) return {};
  auto grid = scene.depths().begin_grid(*depth_, path_.box);
  if (!grid) return tl::unexpected(grid.error());
  grid_ = std::move(*grid);
  return {};
}

Result<void> ComputePainter::dispatch(GpuScene& scene, const PaintTarget& target) {
  const auto begin = std::chrono::steady_clock::now();
  const auto elapsed_ms = [&] {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
  };
  const Camera& camera = stroke_.camera;
  const mesh::Geometry& geometry = target.mesh.geometry();
  const DepthBias bias = depth_bias(geometry);
  DepthGrid grid;
  if (!stroke_.through) grid = {depth_->grid.data(), depth_->grid_width, depth_->grid_height};
  auto candidates =
      BlockCuller(target.map.map(), clip_from_model(geometry), camera.width, camera.height, path_, bias, grid)
          .all(mesh::hardware_threads());
  outcome_.cull_ms = elapsed_ms();
  if (const std::size_t tiles = candidates.count_tiles(); tiles > 0) {
    auto room = scene.tile_reader().make_room(target.layer.pool(), tiles);
    if (!room) return tl::unexpected(room.error());
    tiles_ = std::move(*room);
  }
  auto edit = scene.edit_pass().dispatch(stroke_, geometry.origin, path_, bias, std::move(candidates), target.map,
                                         depth_ ? &depth_->texture : nullptr, target.layer, scene.tables());
  if (!edit) return tl::unexpected(edit.error());
  edit_ = std::move(*edit);
  outcome_.bytes_up = edit_.bytes_up;
  outcome_.bytes_down = edit_.rows ? edit_.rows.size() : 0;
  outcome_.dispatch_ms = elapsed_ms() - edit_.executed_ms;
  return {};
}

void ComputePainter::collect_rows(GpuScene& scene, const PaintTarget& target) {
  auto masks = EditPass::written_masks(edit_);
  for (const TileAddress tile : edit_.fresh_tiles) {
    if (!masks.contains(tile)) target.layer.free_page(tile);
  }
  if (!masks.empty()) outcome_.gpu_ms = std::max(scene.edit_pass().gpu_ms(), edit_.executed_ms);
  glm::vec3 low(std::numeric_limits<float>::max()), high(-std::numeric_limits<float>::max());
  const mesh::SurfaceMap& map = target.map.map();
  for (const CandidateBlock& block : edit_.blocks) {
    const auto mask = masks.find(block.tile);
    if (mask == masks.end()) continue;
    const auto first_texel = (block.block_in_tile >> 4) * 8 * kTileSize + (block.block_in_tile & 15) * 8;
    bool written = false;
    for (std::uint32_t row = 0; row < 8 && !written; ++row) {
      const std::uint32_t texel = first_texel + row * kTileSize;
      written = (mask->second.words[texel / 64] >> (texel % 64) & 0xffu) != 0;
    }
    if (!written) continue;
    const auto& bounds = block.bounds(map);
    low = glm::min(low, bounds.center - bounds.radius);
    high = glm::max(high, bounds.center + bounds.radius);
  }
  if (!masks.empty()) {
    outcome_.written_min = low;
    outcome_.written_max = high;
  }
  for (auto& [tile, mask] : masks) outcome_.tiles.push_back({tile, mask, TileData(target.layer.type())});
  edit_.rows = {};
}

void ComputePainter::begin_tiles(GpuScene& scene, const PaintTarget& target) {
  std::vector<PageId> pages;
  reading_.clear();
  while (next_tile_ < outcome_.tiles.size() && pages.size() < TileReader::kMaxPages) {
    const PageId page = target.layer.page(outcome_.tiles[next_tile_].address);
    if (page != shader::kNoPage) {  // erased where nothing is: the tile stays empty
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
