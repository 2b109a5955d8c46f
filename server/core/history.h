#pragma once

#include <cstdint>
#include <span>

#include "core/revision.h"

namespace strata {

// One revision of a tile and what its edit is now: `writer` is false for the entries that undo and redo leave
// (they move content but are nobody's paint); `in_force` is false for an edit that is undone. A restore is a writer: later undos
// see what it brought back.
struct PastRevision {
  std::int64_t sequence = 0;
  bool writer = true;
  bool in_force = true;
  TileRevision revision;
};

// The rule of undo and redo: a texel shows what the newest in-force edit that wrote it left there, or what was there
// before all of them. Recomputes the `texels` of a tile by that rule, after the caller flipped an edit's `in_force`.
// `newest_first` holds every revision of the tile; `current` is the tile after the newest of them.
TileData resolve_tile(const TileData& current, std::span<const PastRevision> newest_first, const TileMask& texels);

}  // namespace strata
