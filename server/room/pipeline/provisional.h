#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "domain/layers/layer.h"
#include "domain/layers/palette.h"
#include "domain/layers/tile_mirror.h"
#include "render/renderer.h"
#include "room/pipeline/tile_changes.h"
#include "store/store.h"

namespace strata::room {

// The texels of a layer that wait for review, as the content of a layer of u8: 1 where they do, and
// nothing elsewhere. A texel waits where the newest edit in force that wrote it does, also where
// that edit has erased it.

// From the journal; blocks.
Result<TileMap> read_provisional(store::Store& store, const Layer& layer);

// The tile after the change; `before` may be null, which is a tile without any.
std::shared_ptr<const TileData> with_provisional(const std::shared_ptr<const TileData>& before,
                                                 const TileChange& change);

// What marks them: the palette of such a layer of u8, for over the layer itself.
std::shared_ptr<const Palette> provisional_palette();
// A layer's own style, and over it the mark of what waits.
void add_styles(const render::LayerStyle& style, std::optional<render::LayerHandle> waiting,
                std::vector<render::LayerStyle>& styles);

}  // namespace strata::room
