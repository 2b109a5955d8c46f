#pragma once

#include <deque>
#include <map>
#include <span>

#include "core/ids.h"
#include "store/journal/journal.h"
#include "store/pg/pg.h"

namespace strata::store {

// By layer and tile.
using TileKeysByPlace = std::map<std::pair<LayerId, TileAddress>, std::vector<KeySum>>;

// The statements that write them in place of what was there.
void write_tile_sums(const TileKeysByPlace& tiles, std::deque<PgConnection::Statement>& out);

// The same with what the entries say of their tiles, of which the last counts; layers of entries
// that do not say it are marked.
void write_tile_sums(std::span<const JournalEntry* const> entries,
                     std::deque<PgConnection::Statement>& out);

}  // namespace strata::store
