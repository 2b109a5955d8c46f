#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "domain/layers/layer.h"
#include "domain/layers/palette.h"
#include "domain/layers/tile_mirror.h"
#include "render/renderer.h"
#include "room/pipeline/tile_changes.h"
#include "store/store.h"

namespace strata::room {

// The texels of a layer that wait for review, as the content of a layer of u8. The value is 1 if
// the texel waits, and there is no value elsewhere. A texel waits if the newest edit in force that
// wrote it waits for review, even if that edit erased the texel.

// Reads these texels from the journal. Blocks.
Result<TileMap> read_provisional(store::Store& store, const Layer& layer);
// Reads the tiles that change when these edits have painted. `before` are all such tiles before the
// edits. Blocks.
Result<TileMap> read_provisional(store::Store& store, const Layer& layer,
                                 std::span<const std::int64_t> edits, const TileMap& before);

// Returns the tile after the change. `before` may be null for an empty tile.
std::shared_ptr<const TileData> with_provisional(const std::shared_ptr<const TileData>& before,
                                                 const TileChange& change);

// Returns the palette for such a layer of u8, which is drawn over the original layer.
std::shared_ptr<const Palette> provisional_palette();
// Appends the style of a layer and, over it, the mask of the texels that wait for review.
void add_styles(const render::LayerStyle& style, std::optional<render::LayerHandle> waiting,
                std::vector<render::LayerStyle>& styles);

}  // namespace strata::room
