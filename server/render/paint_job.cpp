#include "render/paint_job.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>

#include "shared/pages.h"

namespace strata::render {
namespace {

std::uint32_t bits_of_width(std::uint32_t bits, int bytes) {
  return bytes == 4 ? bits : bits & ((1u << (bytes * 8)) - 1u);
}

}  // namespace

Result<void> validate(const StrokeBatch& stroke) {
  if (auto camera = validate(stroke.camera); !camera) return camera;
  if (stroke.path.empty() || stroke.path.size() > kMaxPathPoints) {
    return fail(422, "Path length out of range",
                "A stroke has 1 to " + std::to_string(kMaxPathPoints) + " points; send a longer one in parts.", "path");
  }
  for (const auto& point : stroke.path) {
    if (!std::isfinite(point.x) || !std::isfinite(point.y)) {
      return fail(422, "Path not finite", "Every coordinate of the path must be a finite number.", "path");
    }
  }
  const double radius = stroke.radius_px > 0 ? stroke.radius_px : stroke.radius_world;
  if (!std::isfinite(radius) || radius <= 0) {
    return fail(422, "Radius out of range", "Give radius_px or radius_world as a number above 0.", "radius");
  }
  return {};
}

Step PaintJob::step(GpuScene& scene) {
  auto found = target(scene);
  auto step = found ? advance(scene, *found) : tl::unexpected(found.error());
  if (step) return *step;
  abort(step.error());
  return Step::done;
}

Result<PaintJob::Target> PaintJob::target(GpuScene& scene) {
  auto layer = scene.layer(layer_);
  if (!layer) return tl::unexpected(layer.error());
  auto model = scene.model((*layer)->model);
  if (!model) return tl::unexpected(model.error());
  LayerTextures& textures = *(*layer)->textures;
  const auto map = (*model)->maps.find(textures.resolution());
  if (map == (*model)->maps.end()) {
    return fail(409, "Surface map missing",
                "The surface map of " + std::to_string(textures.resolution()) +
                    " texels is not on the GPU yet. Try again soon.");
  }
  return Target{(*model)->mesh(), *map->second, textures};
}

Result<Step> PaintJob::advance(GpuScene& scene, const Target& target) {
  const auto go_to = [this](Stage stage, Result<void> done) -> Result<Step> {
    if (!done) return tl::unexpected(done.error());
    stage_ = stage;
    return Step::more;
  };
  switch (stage_) {
    case Stage::begin:
      if (auto valid = validate(stroke_); !valid) return tl::unexpected(valid.error());
      return go_to(Stage::depth, find_depth(scene));
    case Stage::depth:
      if (depth_ && !depth_->complete && !scene.depths().draw_slice(depth_, target.mesh, stroke_.camera, drawn_))
        return Step::yield;
      return go_to(Stage::radii, begin_radii(scene));
    case Stage::radii:
      if (!path_depths_.ready()) return Step::waiting;
      collect_radii(target.mesh.geometry());
      return go_to(Stage::grid, begin_grid(scene));
    case Stage::grid:
      if (!grid_.cells.ready()) return Step::waiting;
      if (depth_) DepthBuffers::finish_grid(*depth_, grid_);
      return go_to(Stage::dispatch, {});
    case Stage::dispatch: return go_to(Stage::rows, dispatch(scene, target));
    case Stage::rows:
      if (!edit_.rows.ready()) return Step::waiting;
      collect_rows(scene, target);
      begin_tiles(scene, target);
      return go_to(Stage::tiles, {});
    case Stage::tiles:
      if (!tiles_.ready()) return Step::waiting;
      collect_tiles(target);
      if (next_tile_ < outcome_.tiles.size()) {
        begin_tiles(scene, target);
        return Step::more;
      }
      finish(scene);
      return Step::done;
  }
  return Step::done;
}

glm::dmat4 PaintJob::clip_from_model(const mesh::Geometry& geometry) const {
  return stroke_.camera.projection * stroke_.camera.view * glm::translate(glm::dmat4(1.0), geometry.origin);
}

Result<void> PaintJob::find_depth(GpuScene& scene) {
  if (stroke_.through && stroke_.radius_px > 0) return {};
  const Camera& camera = stroke_.camera;
  const DepthKey key{(*scene.layer(layer_))->model, camera.view, camera.projection, camera.width, camera.height};
  depth_ = scene.depths().find(key);
  if (depth_) return {};
  auto started = scene.depths().start(key);
  if (!started) return tl::unexpected(started.error());
  depth_ = std::move(*started);
  return {};
}

Result<void> PaintJob::begin_radii(GpuScene& scene) {
  if (stroke_.radius_px > 0) return {};
  // Points outside the window see nothing.
  std::vector<glm::ivec2> pixels;
  for (std::size_t i = 0; i < stroke_.path.size(); ++i) {
    const glm::dvec2 p = stroke_.path[i];
    if (p.x < 0 || p.y < 0 || p.x >= stroke_.camera.width || p.y >= stroke_.camera.height) continue;
    pixels.emplace_back(static_cast<int>(p.x), stroke_.camera.height - 1 - static_cast<int>(p.y));
    in_window_.push_back(i);
  }
  if (pixels.empty()) return {};
  auto depths = scene.depths().begin_gather(*depth_, pixels);
  if (!depths) return tl::unexpected(depths.error());
  path_depths_ = std::move(*depths);
  return {};
}

void PaintJob::collect_radii(const mesh::Geometry& geometry) {
  const std::size_t count = stroke_.path.size();
  if (stroke_.radius_px > 0) {
    path_ = make_tool_path(stroke_, std::vector<double>(count, stroke_.radius_px));
    return;
  }
  std::vector<float> depths(count, 1.0f);
  if (path_depths_) {
    const auto gathered = DepthBuffers::finish_gather(path_depths_);
    for (std::size_t i = 0; i < in_window_.size(); ++i) depths[in_window_[i]] = gathered[i];
  }
  path_depths_ = {};
  const glm::dvec3 center = (glm::dvec3(geometry.box_min) + glm::dvec3(geometry.box_max)) * 0.5;
  const double center_w = (clip_from_model(geometry) * glm::dvec4(center, 1)).w;
  path_ = make_tool_path(stroke_, radii_from_depths(stroke_, depths, center_w > 0 ? center_w : 1.0));
}

Result<void> PaintJob::begin_grid(GpuScene& scene) {
  if (stroke_.through) return {};
  auto grid = scene.depths().begin_grid(*depth_, path_.box);
  if (!grid) return tl::unexpected(grid.error());
  grid_ = std::move(*grid);
  return {};
}

Result<void> PaintJob::dispatch(GpuScene& scene, const Target& target) {
  const auto begin = std::chrono::steady_clock::now();
  const auto elapsed_ms = [&] {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
  };
  const Camera& camera = stroke_.camera;
  const mesh::Geometry& geometry = target.mesh.geometry();
  StrokeBatch stroke = stroke_;
  stroke.value_bits = bits_of_width(stroke.value_bits, target.layer.pool().texel_bytes());
  DepthBias bias = slope_aware_bias(camera, glm::length(glm::dvec3(geometry.box_max) - glm::dvec3(geometry.box_min)));
  bias.is_fixed = scene.options().paper_depth_bias;
  bias.fixed = kPaperDepthBias;
  DepthGrid grid;
  if (!stroke.through) grid = {depth_->grid.data(), depth_->grid_width, depth_->grid_height};
  auto candidates =
      cull_blocks(target.map.map(), clip_from_model(geometry), camera.width, camera.height, path_, bias, grid);
  outcome_.cull_ms = elapsed_ms();
  if (const std::size_t tiles = candidates.count_tiles(); tiles > 0) {
    auto room = scene.tile_reader().make_room(target.layer.pool(), tiles);
    if (!room) return tl::unexpected(room.error());
    tiles_ = std::move(*room);
  }
  auto edit = scene.edit_pass().dispatch(stroke, strata::clip_from_model(camera, geometry.origin), path_, bias,
                                         std::move(candidates), target.map, depth_ ? &depth_->texture : nullptr,
                                         target.layer, scene.tables());
  if (!edit) return tl::unexpected(edit.error());
  edit_ = std::move(*edit);
  outcome_.bytes_up = edit_.bytes_up;
  outcome_.dispatch_ms = elapsed_ms() - edit_.executed_ms;
  return {};
}

void PaintJob::collect_rows(GpuScene& scene, const Target& target) {
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
    const auto& bounds = map.bounds_8[block.slot];
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

void PaintJob::begin_tiles(GpuScene& scene, const Target& target) {
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
}

void PaintJob::collect_tiles(const Target& target) {
  for (std::size_t i = 0; i < reading_.size(); ++i) {
    WrittenTile& tile = outcome_.tiles[reading_[i]];
    tile.after = TileReader::tile(tiles_, target.layer.pool(), i);
    if (!tile.after.valid.any()) target.layer.free_page(tile.address);
  }
  reading_.clear();
}

void PaintJob::finish(GpuScene& scene) {
  // A reset between dispatch and read-back leaves rubbish in the mapped memory.
  if (scene.lost()) {
    abort({503,
           "GPU lost",
           "The GPU context was lost and is being rebuilt. The stroke was not painted; send it again.",
           {}});
    return;
  }
  done_(std::move(outcome_));
}

}  // namespace strata::render
