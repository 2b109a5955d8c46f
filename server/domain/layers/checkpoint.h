#pragma once

#include <optional>
#include <span>

#include "domain/layers/history.h"
#include "domain/layers/revision.h"

namespace strata {

// Consecutive revisions of a tile, joined into at most two: first `written`, then `rest`. The tile
// before them and after them stays the same, and so does the result of every later undo, if the
// states of the joined edits never change again.
struct Checkpoint {
  // The texels that edits in force wrote, and their change by the newest of these edits and all
  // revisions before it. A writer in force. Empty if there are no such texels.
  std::optional<TileRevision> written;
  // The other changes: by edits that are no longer in force, and by undo, redo and reviews. Not a
  // writer in force. Empty without such changes.
  std::optional<TileRevision> rest;
};

// `revisions` are sorted by ascending sequence, and not empty.
Checkpoint join_revisions(std::span<const PastRevision> revisions);

// Returns whether the checkpoint has the same effect on the tile and on later undos. Uses
// TileResolver and not the method of `join_revisions`, so that one can check the other.
bool is_equivalent(std::span<const PastRevision> revisions, const Checkpoint& checkpoint);

}  // namespace strata
