#include "render/paint_job.h"

#include <chrono>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>

#include "shared/pages.h"

namespace strata::render {
namespace {

constexpr std::size_t kMaxPathPoints = 4096;

std::uint32_t bits_of_width(std::uint32_t bits, int bytes) { return bytes == 4 ? bits : bits & ((1u << (bytes * 8)) - 1u); }

}  // namespace

Result<void> validate(const StrokeBatch& stroke) {
  if (auto camera = validate(stroke.camera); !camera) return camera;
  if (stroke.path.empty() || stroke.path.size() > kMaxPathPoints) {
    return fail(422, "Path length out of range", "A stroke has 1 to 4096 points; send a longer one in parts.", "path");
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
  auto layer = scene.layer(layer_);
  const auto refuse = [&](const Problem& problem) {
    abort(problem);
    return Step::done;
  };
  if (!layer) return refuse(layer.error());
  switch (stage_) {
    case Stage::dispatch:
      if (auto dispatched = dispatch(scene, **layer); !dispatched) return refuse(dispatched.error());
      stage_ = Stage::rows;
      return Step::more;
    case Stage::rows:
      if (edit_.rows && !edit_.rows.ready()) return Step::waiting;
      collect_rows(scene, **layer);
      if (auto begun = begin_tiles(scene, **layer); !begun) return refuse(begun.error());
      stage_ = Stage::tiles;
      return Step::more;
    case Stage::tiles:
      if (tiles_ && !tiles_.ready()) return Step::waiting;
      collect_tiles(**layer);
      if (next_tile_ < outcome_.tiles.size()) {
        if (auto begun = begin_tiles(scene, **layer); !begun) return refuse(begun.error());
        return Step::more;
      }
      finish(scene);
      return Step::done;
  }
  return Step::done;
}

Result<void> PaintJob::dispatch(GpuScene& scene, GpuScene::Layer& layer) {
  if (auto valid = validate(stroke_); !valid) return valid;
  auto model = scene.model(layer.model);
  if (!model) return tl::unexpected(model.error());
  const auto map = (*model)->maps.find(layer.textures->resolution());
  if (map == (*model)->maps.end()) {
    return fail(409, "Surface map missing",
                "The surface map of " + std::to_string(layer.textures->resolution()) + " texels is not on the GPU yet. Try again soon.");
  }
  const MeshBuffers& mesh = *(*model)->mesh;
  const Camera& camera = stroke_.camera;
  const glm::dmat4 clip = camera.projection * camera.view * glm::translate(glm::dmat4(1.0), mesh.geometry().origin);

  std::shared_ptr<DepthBuffer> depth;
  const bool needs_depth = !stroke_.through || stroke_.radius_px <= 0;
  if (needs_depth) {
    auto got = scene.depths().get({layer.model, camera.view, camera.projection, camera.width, camera.height}, mesh, camera);
    if (!got) return tl::unexpected(got.error());
    depth = std::move(*got);
  }
  auto radii_px = radii(scene, depth.get(), clip, mesh.geometry());
  if (!radii_px) return tl::unexpected(radii_px.error());

  const auto begin = std::chrono::steady_clock::now();
  StrokeBatch stroke = stroke_;
  stroke.value_bits = bits_of_width(stroke.value_bits, layer.textures->pool().texel_bytes());
  const ToolPath path = make_tool_path(stroke, *radii_px);
  const double diagonal = glm::length(glm::dvec3(mesh.geometry().box_max) - glm::dvec3(mesh.geometry().box_min));
  DepthBias bias = slope_aware_bias(camera, diagonal);
  bias.is_fixed = scene.options().paper_depth_bias;
  bias.fixed = kPaperDepthBias;
  DepthGrid grid;
  if (!stroke.through) {
    const PixelBox& box = path.box;
    if (auto filled = scene.depths().fill_grid(*depth, box.x0, box.y0, box.x1, box.y1); !filled) return filled;
    grid = {depth->grid.data(), depth->grid_width, depth->grid_height};
  }
  auto candidates = cull_blocks(map->second->map(), clip, camera.width, camera.height, path, bias, grid);
  outcome_.cull_ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
  auto edit = scene.edit_pass().dispatch(stroke, clip_from_model(camera, mesh.geometry().origin), path, bias,
                                         std::move(candidates), *map->second, depth ? &depth->texture : nullptr,
                                         *layer.textures, scene.tables());
  if (!edit) return tl::unexpected(edit.error());
  edit_ = std::move(*edit);
  outcome_.bytes_up = edit_.bytes_up;
  outcome_.dispatch_ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
  return {};
}

Result<std::vector<double>> PaintJob::radii(GpuScene& scene, const DepthBuffer* depth, const glm::dmat4& clip_from_model,
                                            const mesh::Geometry& geometry) {
  const std::size_t count = stroke_.path.size();
  if (stroke_.radius_px > 0) return std::vector<double>(count, stroke_.radius_px);
  // Points outside the window see nothing.
  std::vector<glm::ivec2> pixels;
  std::vector<std::size_t> owners;
  for (std::size_t i = 0; i < count; ++i) {
    const glm::dvec2 p = stroke_.path[i];
    if (p.x < 0 || p.y < 0 || p.x >= stroke_.camera.width || p.y >= stroke_.camera.height) continue;
    pixels.emplace_back(static_cast<int>(p.x), stroke_.camera.height - 1 - static_cast<int>(p.y));
    owners.push_back(i);
  }
  std::vector<float> depths(count, 1.0f);
  if (!pixels.empty()) {
    auto gathered = scene.depths().gather(*depth, pixels);
    if (!gathered) return tl::unexpected(gathered.error());
    for (std::size_t i = 0; i < owners.size(); ++i) depths[owners[i]] = (*gathered)[i];
  }
  const glm::dvec3 center = (glm::dvec3(geometry.box_min) + glm::dvec3(geometry.box_max)) * 0.5;
  const double center_w = (clip_from_model * glm::dvec4(center, 1)).w;
  return radii_from_depths(stroke_, depths, center_w > 0 ? center_w : 1.0);
}

void PaintJob::collect_rows(GpuScene& scene, GpuScene::Layer& layer) {
  auto masks = EditPass::written_masks(edit_);
  for (const TileAddress tile : edit_.fresh_tiles) {
    if (!masks.contains(tile)) layer.textures->free_page(tile);
  }
  if (!masks.empty()) outcome_.gpu_ms = scene.edit_pass().gpu_ms();
  glm::vec3 low(std::numeric_limits<float>::max()), high(-std::numeric_limits<float>::max());
  const auto model = scene.model(layer.model);
  const auto& map = (*model)->maps.at(layer.textures->resolution())->map();
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
  for (auto& [tile, mask] : masks) outcome_.tiles.push_back({tile, mask, TileData(layer.textures->type())});
  edit_.rows = {};
}

Result<void> PaintJob::begin_tiles(GpuScene& scene, GpuScene::Layer& layer) {
  std::vector<PageId> pages;
  reading_.clear();
  while (next_tile_ < outcome_.tiles.size() && pages.size() < TileReader::kMaxPages) {
    const PageId page = layer.textures->page(outcome_.tiles[next_tile_].address);
    if (page != shader::kNoPage) {  // erased where nothing is: the tile stays empty
      pages.push_back(page);
      reading_.push_back(next_tile_);
    }
    ++next_tile_;
  }
  if (pages.empty()) return {};
  auto tiles = scene.tile_reader().begin(layer.textures->pool(), pages);
  if (!tiles) return tl::unexpected(tiles.error());
  tiles_ = std::move(*tiles);
  return {};
}

void PaintJob::collect_tiles(GpuScene::Layer& layer) {
  for (std::size_t i = 0; i < reading_.size(); ++i) {
    WrittenTile& tile = outcome_.tiles[reading_[i]];
    tile.after = TileReader::tile(tiles_, layer.textures->pool(), i);
    if (!tile.after.valid.any()) layer.textures->free_page(tile.address);
  }
  reading_.clear();
  tiles_ = {};
}

void PaintJob::finish(GpuScene& scene) {
  // A reset between dispatch and read-back leaves rubbish in the mapped memory.
  if (scene.lost()) {
    abort({503, "GPU lost", "The GPU context was lost and is being rebuilt. The stroke was not painted; send it again.", {}});
    return;
  }
  done_(std::move(outcome_));
}

}  // namespace strata::render
