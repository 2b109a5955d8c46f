#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "domain/layers/tile_mirror.h"
#include "render/memory/layer_textures.h"

namespace strata::render {

// A layer of the scene. A layer with a mirror is on the GPU while it is shown or painted. If other
// objects need the memory, the layer is evicted: its pages are freed, and uploaded again from the
// mirror before their next use. GPU thread only.
class GpuLayer {
 public:
  // `mirror` is null for a layer that exists on the GPU only. Such a layer is never evicted.
  GpuLayer(std::uint64_t model, std::unique_ptr<LayerTextures> textures,
           std::shared_ptr<const TileMirror> mirror)
      : model_(model),
        textures_(std::move(textures)),
        mirror_(std::move(mirror)),
        is_here_(!mirror_) {}

  std::uint64_t model() const { return model_; }
  LayerTextures& textures() const { return *textures_; }
  std::uint64_t last_used() const { return last_used_; }
  bool is_here() const { return is_here_; }  // the whole layer is on the GPU

  // Returns a token. The layer is not evicted during the token's lifetime. `now` is the number of
  // this use.
  std::shared_ptr<const void> use(std::uint64_t now) {
    last_used_ = now;
    return users_;
  }
  // Uploads the next part of the mirror, within about two milliseconds. Returns true when the whole
  // layer is on the GPU. If it fails, the layer has no pages.
  Result<bool> bring();
  // Returns whether the layer can be evicted. It cannot be evicted while a token exists or a caller
  // holds the mirror, because the pages may contain edits that the mirror lacks.
  bool can_leave() const;
  void leave();

 private:
  Result<void> bring_some();

  const std::uint64_t model_;
  const std::unique_ptr<LayerTextures> textures_;
  const std::shared_ptr<const TileMirror> mirror_;
  bool is_here_;
  std::optional<std::vector<std::pair<TileAddress, std::shared_ptr<const TileData>>>>
      coming_;  // the rest of the mirror, uploaded from the back
  std::shared_ptr<const void> users_ = std::make_shared<char>();
  std::uint64_t last_used_ = 0;
};

}  // namespace strata::render
