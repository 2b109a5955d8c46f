#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "domain/layers/revision.h"

namespace strata {

// Consecutive revisions of one tile, with the tile before the first revision. A segment stores the
// values that each revision wrote and not the difference, because most strokes write one value.
// Therefore, a segment is much smaller than its revisions. The tile can be read at the sequence of
// each revision without older data.
struct TileSegment {
  static constexpr int kMaxRevisions = 64;

  struct Entry {
    std::int64_t sequence = 0;
    TileRevision revision;
    bool operator==(const Entry&) const = default;
  };
  TileData before;
  std::vector<Entry> entries;  // 1 to kMaxRevisions, by ascending sequence
  bool operator==(const TileSegment&) const = default;
};

// Returns the stored format (zstd, with a version). Returns nothing for a segment that it cannot
// represent: if a revision changes texels that it did not write, or if there are too many entries.
std::optional<std::vector<std::uint8_t>> encode_segment(const TileSegment& segment);

// The decoders check every bound, so damaged bytes cause an Error and never a crash.
Result<TileSegment> decode_segment(TileAddress address, ValueType type,
                                   std::span<const std::uint8_t> bytes);
// Returns the tile after the last revision whose sequence is at most `sequence`.
Result<TileData> tile_in_segment(ValueType type, std::span<const std::uint8_t> bytes,
                                 std::int64_t sequence);

}  // namespace strata
