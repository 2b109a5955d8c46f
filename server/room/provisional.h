#pragma once

#include <memory>

#include "core/palette.h"
#include "room/tile_changes.h"
#include "store/store.h"

namespace strata::room {

// The texels of a layer that wait for review, as the content of a layer of u8: 1 where they do, and nothing elsewhere. A texel waits where
// the newest edit in force that wrote it does, also where that edit has erased it.

// From the journal; blocks.
Result<TileMap> read_provisional(store::Store& store, const Layer& layer);

// The tile after the change; `before` may be null, which is a tile without any.
std::shared_ptr<const TileData> with_provisional(const std::shared_ptr<const TileData>& before,
                                                 const TileChange& change);

// How it is marked: a palette for over that of its layer, whose texels are 1 where something waits.
std::shared_ptr<const Palette> provisional_palette();

}  // namespace strata::room
