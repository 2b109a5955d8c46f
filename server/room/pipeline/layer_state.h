#pragma once

#include <memory>
#include <optional>

#include "domain/layers/layer.h"
#include "domain/layers/tile_mirror.h"
#include "query/statistics/tile_sums.h"
#include "render/renderer.h"

namespace strata::room {

struct LayerHandles {
  render::LayerHandle content = 0, provisional = 0;
};

// One layer of an open room. Any thread may copy it while holding the mutex of the room. Only the
// strand may change it, while holding the same mutex.
struct LayerState {
  Layer layer;
  LayerHandles handles;
  std::shared_ptr<TileMirror> mirror;
  // The texels that wait for review (room/pipeline/provisional.h). They are shown over the layer.
  std::shared_ptr<TileMirror> provisional;
  // Returns the mask of the texels that wait for review, if there are any.
  std::optional<render::LayerHandle> waiting() const {
    return provisional->empty() ? std::nullopt : std::optional(handles.provisional);
  }
  std::shared_ptr<const Palette> palette;  // of `layer`; shared with the frames that use it
  std::shared_ptr<query::TileSumsCache> sums = std::make_shared<query::TileSumsCache>();
};

}  // namespace strata::room
