#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "domain/layers/tile.h"

namespace strata {

// The effect of one edit on one tile: the texels it wrote (also those with an unchanged value) and
// the bitwise difference of the content before and after. XOR makes it its own inverse: `apply`
// works forward and backward in history.
struct TileRevision {
  TileAddress address;
  TileMask written;
  TileData difference;  // values: before XOR after; valid: before XOR after
  bool operator==(const TileRevision&) const = default;
};

TileRevision make_revision(TileAddress address, const TileData& before, const TileData& after,
                           const TileMask& written);
void apply(const TileRevision& revision, TileData& tile);

// Storage form (zstd, versioned). Decoding checks every bound: damaged bytes are an Error, never a
// crash.
std::vector<std::uint8_t> encode_revision(const TileRevision& revision);
Result<TileRevision> decode_revision(TileAddress address, ValueType type,
                                     std::span<const std::uint8_t> bytes);
std::vector<std::uint8_t> encode_tile(const TileData& tile);
Result<TileData> decode_tile(ValueType type, std::span<const std::uint8_t> bytes);

}  // namespace strata
