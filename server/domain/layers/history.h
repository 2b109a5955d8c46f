#pragma once

#include <cstdint>

#include "domain/layers/revision.h"

namespace strata {

// One revision of a tile and what its edit is now: `writer` is false for the entries that undo,
// redo and reviews leave (they move content but are nobody's paint); `in_force` is false for an
// edit that is undone or rejected. A restore is a writer: later undos see what it brought back.
struct PastRevision {
  std::int64_t sequence = 0;
  bool writer = true;
  bool in_force = true;
  bool provisional = false;  // it waits for review
  TileRevision revision;
};

// The rule of undo and redo: a texel shows what the newest in-force edit that wrote it left there,
// or what was there before all of them; it is provisional where that edit is. Recomputes the
// `texels` of a tile by that rule, after the caller changed what an edit is, from the tile's
// revisions, which come one by one: a tile may have more of them than fit into memory.
class TileResolver {
 public:
  // `current` is the tile after its newest revision.
  TileResolver(const TileData& current, const TileMask& texels)
      : result_(current), past_(current), open_(texels) {}

  // False when older revisions change nothing more.
  bool is_open() const { return open_.any(); }
  // The newest revision first, then the one before it, and so on.
  void add(const PastRevision& entry);
  // After the oldest revision, or when nothing is open.
  TileData finish() &&;
  // Of the texels, those whose author was found and waits for review.
  const TileMask& provisional() const { return provisional_; }

 private:
  TileData result_;
  TileData past_;  // the tile after the revision that comes next
  TileMask open_;  // texels whose author is not found yet
  TileMask provisional_;
};

}  // namespace strata
