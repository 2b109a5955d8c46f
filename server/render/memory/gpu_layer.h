#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "domain/layers/tile_mirror.h"
#include "render/memory/layer_textures.h"

namespace strata::render {

// A layer of the scene. One that has a mirror is on the GPU while it is shown or painted, and
// leaves it when the memory is wanted elsewhere: its pages are freed, and brought again from the
// mirror before they are next used. GPU thread only.
class GpuLayer {
 public:
  // `mirror` is null for a layer that nobody else knows: it never leaves.
  GpuLayer(std::uint64_t model, std::unique_ptr<LayerTextures> textures,
           std::shared_ptr<const TileMirror> mirror)
      : model_(model),
        textures_(std::move(textures)),
        mirror_(std::move(mirror)),
        is_here_(!mirror_) {}

  std::uint64_t model() const { return model_; }
  LayerTextures& textures() const { return *textures_; }
  std::uint64_t last_used() const { return last_used_; }

  // While the token lives the layer does not leave. `now` counts uses.
  std::shared_ptr<const void> use(std::uint64_t now) {
    last_used_ = now;
    return users_;
  }
  // Brings the next of what the mirror holds, a millisecond or two; true when all of it is here. A
  // Error brings nothing.
  Result<bool> bring();
  // Not one whose pages know of edits that the mirror does not.
  bool can_leave() const;
  void leave();

 private:
  Result<void> bring_some();

  const std::uint64_t model_;
  const std::unique_ptr<LayerTextures> textures_;
  const std::shared_ptr<const TileMirror> mirror_;
  bool is_here_;
  std::optional<std::vector<std::pair<TileAddress, std::shared_ptr<const TileData>>>>
      coming_;  // the next one is the last
  std::shared_ptr<const void> users_ = std::make_shared<char>();
  std::uint64_t last_used_ = 0;
};

}  // namespace strata::render
