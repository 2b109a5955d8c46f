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

// The texels of a layer that wait for review, as the content of a layer of u8: 1 if a texel waits,
// and no value elsewhere. A texel waits if the newest edit in force that wrote it waits, also if
// that edit has erased it.

// From the journal; blocks.
Result<TileMap> read_provisional(store::Store& store, const Layer& layer);

// Returns the tile after the change; `before` may be null for an empty tile.
std::shared_ptr<const TileData> with_provisional(const std::shared_ptr<const TileData>& before,
                                                 const TileChange& change);

// Returns the palette of such a layer of u8, which is drawn over the layer itself.
std::shared_ptr<const Palette> provisional_palette();
// Appends a layer's style and, over it, the mask of the texels that wait.
void add_styles(const render::LayerStyle& style, std::optional<render::LayerHandle> waiting,
                std::vector<render::LayerStyle>& styles);

}  // namespace strata::room
