#pragma once

#include "render/gpu_scene.h"
#include "render/gpu_thread.h"

namespace strata::render {

// Uploads in slices of a few milliseconds. Each ends by `step` returning done or by `abort`.

class ModelUpload {
 public:
  ModelUpload(std::shared_ptr<const mesh::Geometry> geometry, Renderer::Done<ModelHandle> done)
      : geometry_(std::move(geometry)), done_(std::move(done)) {}
  Step step(GpuScene& scene);
  void abort(const Problem& problem) { done_(tl::unexpected(problem)); }

 private:
  std::shared_ptr<const mesh::Geometry> geometry_;
  Renderer::Done<ModelHandle> done_;
  std::unique_ptr<MeshBuffers> mesh_;
};

class SurfaceMapUpload {
 public:
  SurfaceMapUpload(ModelHandle model, std::shared_ptr<const mesh::SurfaceMap> map, Renderer::Done<void> done)
      : model_(model), map_(std::move(map)), done_(std::move(done)) {}
  Step step(GpuScene& scene);
  void abort(const Problem& problem) { done_(tl::unexpected(problem)); }

 private:
  const ModelHandle model_;
  std::shared_ptr<const mesh::SurfaceMap> map_;
  Renderer::Done<void> done_;
  std::unique_ptr<SurfaceMapTextures> textures_;
};

// All pages are made before the first tile is written: a Problem leaves the layer as it was. A new page is not cleared,
// so nobody may see the layer meanwhile.
class TilesUpload {
 public:
  TilesUpload(LayerHandle layer, std::vector<TileUpload> tiles, Renderer::Done<void> done)
      : layer_(layer), tiles_(std::move(tiles)), done_(std::move(done)) {}
  Step step(GpuScene& scene);
  void abort(const Problem& problem) { done_(tl::unexpected(problem)); }

 private:
  Result<Step> advance(GpuScene& scene);
  Result<void> prepare(LayerTextures& layer, const TileUpload& tile);

  const LayerHandle layer_;
  const std::vector<TileUpload> tiles_;
  Renderer::Done<void> done_;
  std::size_t prepared_ = 0, written_ = 0;  // tiles
  std::vector<TileAddress> fresh_;          // pages were made for these
};

}  // namespace strata::render
