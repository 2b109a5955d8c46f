#pragma once

#include <memory>
#include <unordered_map>

#include "core/layer.h"
#include "core/tile_mirror.h"
#include "render/renderer.h"

namespace strata::room {

// One layer of an open room.
struct LayerState {
  Layer layer;
  render::LayerHandle handle = 0;
  std::shared_ptr<TileMirror> mirror;
  std::shared_ptr<const Palette> palette;              // of `layer`, shared with the frames that use it
  std::unordered_map<TileAddress, int> since_key_tile; // revisions since the last whole tile was stored, in this room
};

}  // namespace strata::room
