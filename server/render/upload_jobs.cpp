#include "render/upload_jobs.h"

#include <algorithm>

#include "shared/pages.h"

namespace strata::render {
namespace {

constexpr std::size_t kTilesPerStep = 64;

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

Result<void> TilesUpload::prepare(LayerTextures& layer) {
  const auto bytes = static_cast<std::size_t>(kTexelsPerTile * layer.pool().texel_bytes());
  for (const TileUpload& tile : tiles_) {
    if (!layer.contains(tile.address)) {
      return fail(422, "Tile out of range", "A tile's address must lie inside the layer.", "tiles");
    }
    if (!is_empty(tile) && tile.data->values.size() != bytes) {
      return fail(422, "Tile of another type", "A tile must hold 128 x 128 values of the layer's type.", "tiles");
    }
  }
  std::vector<TileAddress> fresh;
  for (const TileUpload& tile : tiles_) {
    if (is_empty(tile) || layer.page(tile.address) != shader::kNoPage) continue;
    if (auto page = layer.ensure_page(tile.address); !page) {
      for (const TileAddress address : fresh) layer.free_page(address);
      return tl::unexpected(page.error());
    }
    fresh.push_back(tile.address);
  }
  return {};
}

Step TilesUpload::step(GpuScene& scene) {
  const auto refuse = [&](const Problem& problem) {
    abort(problem);
    return Step::done;
  };
  auto layer = scene.layer(layer_);
  if (!layer) return refuse(layer.error());
  LayerTextures& textures = *(*layer)->textures;
  if (!prepared_) {
    if (auto prepared = prepare(textures); !prepared) return refuse(prepared.error());
    prepared_ = true;
  }
  const std::size_t last = std::min(next_ + kTilesPerStep, tiles_.size());
  for (; next_ < last; ++next_) {
    const TileUpload& tile = tiles_[next_];
    if (is_empty(tile)) textures.free_page(tile.address);
    else if (auto page = textures.ensure_page(tile.address); page) textures.pool().upload(*page, *tile.data);
    else return refuse(page.error());
  }
  if (next_ < tiles_.size()) return Step::more;
  if (auto flushed = scene.tables().flush(); !flushed) return refuse(flushed.error());
  done_({});
  return Step::done;
}

}  // namespace strata::render
