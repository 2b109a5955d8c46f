#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "domain/layers/tile.h"

namespace strata {

// The effect of one edit on one tile. It consists of the texels that the edit wrote (even with an
// unchanged value) and the bitwise difference between the content before and after. The XOR
// difference is its own inverse, so `apply` moves forward and backward in the history.
struct TileRevision {
  TileAddress address;
  TileMask written;
  TileData difference;  // before XOR after, for the values and for `valid`
  bool operator==(const TileRevision&) const = default;
};

TileRevision make_revision(TileAddress address, const TileData& before, const TileData& after,
                           const TileMask& written);
void apply(const TileRevision& revision, TileData& tile);
// Adds the next revision of the same tile. The result changes the content before the first
// revision into the content after the second revision.
void append(const TileRevision& next, TileRevision& revision);
// Returns whether only written texels differ. Undo requires this of merged revisions.
bool differs_only_where_written(const TileRevision& revision);

// Convert to and from the stored format (zstd, with a version). The decoders check every bound, so
// damaged bytes cause an Error and never a crash.
std::vector<std::uint8_t> encode_revision(const TileRevision& revision);
Result<TileRevision> decode_revision(TileAddress address, ValueType type,
                                     std::span<const std::uint8_t> bytes);
std::vector<std::uint8_t> encode_tile(const TileData& tile);
Result<TileData> decode_tile(ValueType type, std::span<const std::uint8_t> bytes);

}  // namespace strata
