#include "render/upload_jobs.h"

#include <algorithm>

#include "shared/pages.h"

namespace strata::render {
namespace {

constexpr std::size_t kTilesPreparedPerStep = 4096, kTilesWrittenPerStep = 64;

bool is_empty(const TileUpload& tile) { return !tile.data || tile.data->values.empty() || !tile.data->valid.any(); }

}  // namespace

Step ModelUpload::step(GpuScene& scene) {
  if (!mesh_) {
    if (!geometry_ || geometry_->indices.empty() || geometry_->vertices.empty()) {
      abort({422, "Model is empty", "A model needs at least one triangle.", "geometry"});
      return Step::done;
    }
    auto mesh = MeshBuffers::create(geometry_, scene.memory());
    if (!mesh) {
      abort(mesh.error());
      return Step::done;
    }
    mesh_ = std::move(*mesh);
  }
  if (!mesh_->upload_slice()) return Step::more;
  GpuScene::Model model;
  model.mesh = std::move(mesh_);
  done_(scene.add(std::move(model)));
  return Step::done;
}

Step SurfaceMapUpload::step(GpuScene& scene) {
  auto model = scene.model(model_);
  if (!model) {
    abort(model.error());
    return Step::done;
  }
  if (!textures_) {
    auto textures = SurfaceMapTextures::create(map_, scene.memory());
    if (!textures) {
      abort(textures.error());
      return Step::done;
    }
    textures_ = std::move(*textures);
  }
  if (!textures_->upload_slice()) return Step::more;
  (*model)->maps[map_->resolution] = std::move(textures_);
  done_({});
  return Step::done;
}

Step TilesUpload::step(GpuScene& scene) {
  const auto step = advance(scene);
  if (step) return *step;
  if (const auto layer = scene.layer(layer_); layer) {
    for (const TileAddress tile : fresh_) (*layer)->textures->free_page(tile);
  }
  abort(step.error());
  return Step::done;
}

Result<Step> TilesUpload::advance(GpuScene& scene) {
  auto layer = scene.layer(layer_);
  if (!layer) return tl::unexpected(layer.error());
  LayerTextures& textures = *(*layer)->textures;
  if (prepared_ < tiles_.size()) {
    const std::size_t end = std::min(prepared_ + kTilesPreparedPerStep, tiles_.size());
    for (; prepared_ < end; ++prepared_) {
      if (auto prepared = prepare(textures, tiles_[prepared_]); !prepared) return tl::unexpected(prepared.error());
    }
    return Step::more;
  }
  const std::size_t end = std::min(written_ + kTilesWrittenPerStep, tiles_.size());
  for (; written_ < end; ++written_) {
    const TileUpload& tile = tiles_[written_];
    if (is_empty(tile)) {
      textures.free_page(tile.address);
      continue;
    }
    auto page = textures.ensure_page_for_upload(tile.address);
    if (!page) return tl::unexpected(page.error());
    textures.pool().upload(*page, *tile.data);
  }
  if (written_ < tiles_.size()) return Step::more;
  if (auto flushed = scene.tables().flush(); !flushed) return tl::unexpected(flushed.error());
  done_({});
  return Step::done;
}

Result<void> TilesUpload::prepare(LayerTextures& layer, const TileUpload& tile) {
  if (!layer.contains(tile.address)) {
    return fail(422, "Tile out of range", "A tile's address must lie inside the layer.", "tiles");
  }
  if (is_empty(tile)) return {};
  if (tile.data->values.size() != static_cast<std::size_t>(kTexelsPerTile * layer.pool().texel_bytes())) {
    return fail(422, "Tile of another type", "A tile must hold 128 x 128 values of the layer's type.", "tiles");
  }
  if (layer.page(tile.address) != shader::kNoPage) return {};
  auto page = layer.ensure_page_for_upload(tile.address);
  if (!page) return tl::unexpected(page.error());
  fresh_.push_back(tile.address);
  return {};
}

}  // namespace strata::render
