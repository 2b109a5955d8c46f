#pragma once

#include <cstdint>

#include "domain/layers/revision.h"

namespace strata {

// A revision of a tile and the current state of its edit: `writer` is false for the entries of
// undo, redo and reviews (they move content but paint nothing); `in_force` is false for an edit
// that is undone or rejected. A restore is a writer: later undos take its content into account.
struct PastRevision {
  std::int64_t sequence = 0;
  bool writer = true;
  bool in_force = true;
  bool provisional = false;  // waits for review
  TileRevision revision;
};

// The rule of undo and redo: a texel shows the result of the newest in-force edit that wrote it,
// otherwise the content before all edits; it is provisional if that edit is. Recomputes the
// `texels` of a tile by that rule, after the caller changed the state of an edit. The revisions are
// passed one by one, since a tile may have more of them than fit into memory.
class TileResolver {
 public:
  // `current` is the tile after its newest revision.
  TileResolver(const TileData& current, const TileMask& texels)
      : result_(current), past_(current), open_(texels) {}

  // False when older revisions cannot change the result.
  bool is_open() const { return open_.any(); }
  // Call with the newest revision first, then the one before it, and so on.
  void add(const PastRevision& entry);
  // Call after the oldest revision, or when `is_open` is false.
  TileData finish() &&;
  // Those of the texels whose author is known and waits for review.
  const TileMask& provisional() const { return provisional_; }

 private:
  TileData result_;
  TileData past_;  // the tile before the revisions that were added
  TileMask open_;  // texels whose author is still unknown
  TileMask provisional_;
};

}  // namespace strata
