#pragma once

#include "render/thread/gpu_scene.h"
#include "render/thread/gpu_thread.h"

namespace strata::render {

// These jobs upload data in slices of a few milliseconds.

class ModelUpload {
 public:
  ModelUpload(ModelGeometry geometry, Renderer::Done<ModelHandle> done)
      : geometry_(std::move(geometry)), done_(std::move(done)) {}
  Step step(GpuScene& scene);
  void abort(const Error& problem) { done_(tl::unexpected(problem)); }

 private:
  Result<bool> advance(GpuScene& scene);  // true when complete

  const ModelGeometry geometry_;
  Renderer::Done<ModelHandle> done_;
  GpuScene::Model model_;
};

class SurfaceImageUpload {
 public:
  SurfaceImageUpload(ModelHandle model, std::shared_ptr<const MipmappedPicture> image,
                     Renderer::Done<SurfaceImageHandle> done)
      : model_(model), image_(std::move(image)), done_(std::move(done)) {}
  Step step(GpuScene& scene);
  void abort(const Error& problem) { done_(tl::unexpected(problem)); }

 private:
  Result<bool> advance(GpuScene& scene);  // true when complete

  const ModelHandle model_;
  std::shared_ptr<const MipmappedPicture> image_;
  Renderer::Done<SurfaceImageHandle> done_;
  std::unique_ptr<SurfaceImageTexture> texture_;
};

class SurfaceMapUpload {
 public:
  SurfaceMapUpload(ModelHandle model, std::shared_ptr<const mesh::SurfaceMap> map,
                   Renderer::Done<void> done)
      : model_(model), map_(std::move(map)), done_(std::move(done)) {}
  Step step(GpuScene& scene);
  void abort(const Error& problem) { done_(tl::unexpected(problem)); }

 private:
  const ModelHandle model_;
  std::shared_ptr<const mesh::SurfaceMap> map_;
  Renderer::Done<void> done_;
  std::unique_ptr<SurfaceMapTextures> textures_;
};

// Allocates all pages before it writes the first tile, so the layer is unchanged if the allocation
// fails. A page becomes visible only when it contains its tile. Therefore frames may be drawn
// between the steps.
class TilesUpload {
 public:
  TilesUpload(LayerHandle layer, std::vector<TileUpload> tiles, Renderer::Done<void> done)
      : layer_(layer), tiles_(std::move(tiles)), done_(std::move(done)) {}
  Step step(GpuScene& scene);
  void abort(const Error& problem);

 private:
  Result<bool> advance(GpuScene& scene);  // true when complete
  Result<void> prepare(LayerTextures& layer, const TileUpload& tile);
  Result<void> write(LayerTextures& layer, const TileUpload& tile);
  void give_back_pages();

  const LayerHandle layer_;
  const std::vector<TileUpload> tiles_;
  Renderer::Done<void> done_;
  std::shared_ptr<const void> layer_use_;
  std::size_t prepared_ = 0, written_ = 0;  // numbers of tiles
  PagePool* pool_ = nullptr;                // the layer's pool
  std::vector<PageId> pages_;               // pages of `pool_` for tiles without a page
};

}  // namespace strata::render
