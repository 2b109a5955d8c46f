#pragma once

#include <deque>
#include <map>
#include <span>

#include "core/ids.h"
#include "store/journal/journal.h"
#include "store/pg/pg.h"

namespace strata::store {

// The sums of keys by layer and tile.
using TileKeysByPlace = std::map<std::pair<LayerId, TileAddress>, std::vector<KeySum>>;

// Appends the statements that replace the stored sums.
void write_tile_sums(const TileKeysByPlace& tiles, std::deque<PgConnection::Statement>& out);

// Appends the same statements for the sums of the entries. Uses only the last entry of each tile.
// Marks the layers of entries without sums.
void write_tile_sums(std::span<const JournalEntry* const> entries,
                     std::deque<PgConnection::Statement>& out);

}  // namespace strata::store
