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

// One layer of an open room. Copied by any thread under the room's mutex: what the strand changes
// is changed under it, too.
struct LayerState {
  Layer layer;
  LayerHandles handles;
  std::shared_ptr<TileMirror> mirror;
  // what of it waits for review (room/pipeline/provisional.h), shown over it
  std::shared_ptr<TileMirror> provisional;
  std::optional<render::LayerHandle> waiting() const {  // the mark of that, where anything does
    return provisional->empty() ? std::nullopt : std::optional(handles.provisional);
  }
  std::shared_ptr<const Palette> palette;  // of `layer`, shared with the frames that use it
  std::shared_ptr<query::TileSumsCache> sums = std::make_shared<query::TileSumsCache>();
};

}  // namespace strata::room
