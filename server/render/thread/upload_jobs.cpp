#include "render/thread/upload_jobs.h"

#include <algorithm>

#include "shared/pages.h"

namespace strata::render {
namespace {

constexpr std::size_t kTilesPreparedPerStep = 4096, kTilesWrittenPerStep = 64;

bool is_empty(const TileUpload& tile) {
  return !tile.data || tile.data->values.empty() || !tile.data->valid.any();
}

}  // namespace

Step ModelUpload::step(GpuScene& scene) {
  const auto complete = advance(scene);
  if (!complete) {
    abort(complete.error());
    return Step::done;
  }
  if (!*complete) return Step::more;
  done_(scene.add(std::move(model_)));
  return Step::done;
}

Result<bool> ModelUpload::advance(GpuScene& scene) {
  const std::size_t level = model_.levels.size();
  if (level > 0 && !model_.levels.back()->upload_slice()) return false;
  if (level > geometry_.coarser.size()) return true;
  const auto& geometry = level == 0 ? geometry_.full : geometry_.coarser[level - 1];
  if (!geometry || geometry->indices.empty() || geometry->vertices.empty())
    return fail(ErrorCode::invalid, "Model is empty", "A model must have at least one triangle.",
                "geometry");
  auto mesh = STRATA_TRY(MeshBuffers::create(geometry, scene.memory()));
  model_.levels.push_back(std::move(mesh));
  return false;
}

Step SurfaceImageUpload::step(GpuScene& scene) {
  const auto complete = advance(scene);
  if (!complete) {
    abort(complete.error());
    return Step::done;
  }
  if (!*complete) return Step::more;
  done_(scene.add({model_, std::move(texture_)}));
  return Step::done;
}

Result<bool> SurfaceImageUpload::advance(GpuScene& scene) {
  STRATA_TRY(scene.model(model_));
  if (!texture_) {
    if (!image_ || image_->levels.empty())
      return fail(ErrorCode::invalid, "Invalid surface image",
                  "The picture of a surface image must not be larger than the GPU supports.",
                  "look");
    auto texture = STRATA_TRY(
        SurfaceImageTexture::create(std::move(image_), scene.info().software, scene.memory()));
    texture_ = std::move(texture);
    return false;
  }
  return texture_->upload_slice();
}

Step SurfaceMapUpload::step(GpuScene& scene) {
  auto model = scene.model(model_);
  if (!model) {
    abort(model.error());
    return Step::done;
  }
  if (!textures_ && scene.edits_on_cpu()) textures_ = SurfaceMapTextures::on_cpu(map_);
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
  const auto complete = advance(scene);
  if (!complete) {
    abort(complete.error());
    return Step::done;
  }
  if (!*complete) return Step::yield;
  give_back_pages();
  done_({});
  return Step::done;
}

void TilesUpload::abort(const Error& problem) {
  give_back_pages();
  done_(tl::unexpected(problem));
}

void TilesUpload::give_back_pages() {
  for (const PageId page : pages_) pool_->free(page);
  pages_.clear();
}

Result<bool> TilesUpload::advance(GpuScene& scene) {
  auto layer = STRATA_TRY(scene.layer(layer_));
  LayerTextures& textures = layer->textures();
  if (!layer_use_) layer_use_ = layer->use(scene.next_use());
  if (const auto here = layer->bring(); !here || !*here) return here;
  pool_ = &textures.pool();
  if (prepared_ < tiles_.size()) {
    const std::size_t end = std::min(prepared_ + kTilesPreparedPerStep, tiles_.size());
    for (; prepared_ < end; ++prepared_) {
      STRATA_TRY(prepare(textures, tiles_[prepared_]));
    }
    return false;
  }
  const std::size_t end = std::min(written_ + kTilesWrittenPerStep, tiles_.size());
  for (; written_ < end; ++written_) {
    STRATA_TRY(write(textures, tiles_[written_]));
  }
  if (written_ < tiles_.size()) return false;
  STRATA_TRY(scene.tables().flush());
  return true;
}

Result<void> TilesUpload::prepare(LayerTextures& layer, const TileUpload& tile) {
  if (!layer.contains(tile.address)) {
    return fail(ErrorCode::invalid, "Tile out of range",
                "The address of a tile must be inside the layer.", "tiles");
  }
  if (is_empty(tile)) return {};
  if (tile.data->values.size() != static_cast<std::size_t>(kTexelsPerTile * pool_->texel_bytes())) {
    return fail(ErrorCode::invalid, "Wrong type of tile",
                "A tile must contain 128 x 128 values of the type of the layer.", "tiles");
  }
  if (layer.page(tile.address) != shader::kNoPage) return {};
  auto page = STRATA_TRY(pool_->allocate());
  pages_.push_back(page);
  return {};
}

Result<void> TilesUpload::write(LayerTextures& layer, const TileUpload& tile) {
  if (is_empty(tile)) {
    layer.free_page(tile.address);
    return {};
  }
  if (const PageId present = layer.page(tile.address); present != shader::kNoPage) {
    pool_->upload(present, *tile.data);
    return {};
  }
  if (pages_.empty()) {  // the tile had a page when it was prepared, but lost it since then
    auto page = STRATA_TRY(pool_->allocate());
    pages_.push_back(page);
  }
  pool_->upload(pages_.back(), *tile.data);
  layer.put_page(tile.address, pages_.back());
  pages_.pop_back();
  return {};
}

}  // namespace strata::render
