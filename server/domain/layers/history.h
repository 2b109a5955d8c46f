#pragma once

#include <cstdint>

#include "domain/layers/revision.h"

namespace strata {

// A revision of a tile, with the current state of its edit. `writer` is false for undo, redo and
// reviews: they change the content, but paint nothing new. `in_force` is false for an edit that is
// undone or rejected. A restore is a writer, so later undos take its content into account.
struct PastRevision {
  std::int64_t sequence = 0;
  bool writer = true;
  bool in_force = true;
  bool provisional = false;  // the edit waits for review
  TileRevision revision;
};

// Recomputes the `texels` of a tile after the caller has changed the state of an edit. The rule of
// undo and redo is: a texel shows the result of the newest edit in force that wrote it. Without
// such an edit, it shows the content before all edits. The texel is provisional if that edit is
// provisional. The caller passes the revisions one by one, because a tile may have more revisions
// than fit into memory.
class TileResolver {
 public:
  // `current` is the tile after its newest revision.
  TileResolver(const TileData& current, const TileMask& texels)
      : result_(current), past_(current), open_(texels) {}

  // Returns false if older revisions cannot change the result.
  bool is_open() const { return open_.any(); }
  // Call with the newest revision first, then with the revision before it, and so on.
  void add(const PastRevision& entry);
  // Call after the oldest revision, or when `is_open` is false.
  TileData finish() &&;
  // Returns the texels that show the result of an edit that waits for review.
  const TileMask& provisional() const { return provisional_; }

 private:
  TileData result_;
  TileData past_;  // the tile before the revisions that were added so far
  TileMask open_;  // texels for which no edit was found yet
  TileMask provisional_;
};

}  // namespace strata
