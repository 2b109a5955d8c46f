#pragma once
#include "shared/types.h"
// A page id is the position of a tile in the texel pools: chunk << 19 | slice << 8 | cell. A cell
// is one of the 16 x 16 tiles in a slice of 2048 x 2048 texels.
STRATA_SHARED_BEGIN
const uint kNoPage = 0xffffffffu;
const uint kTileTexels = 128u;       // along a side
const uint kCellsPerSide = 16u;
const uint kPageCellBits = 8u;
const uint kPageSliceBits = 11u;
const uint kPageChunkShift = 19u;
const uint kPageSliceMask = 0x7ffu;
const uint kPageCellMask = 0xffu;

// Surface positions: texel i of a slot is element slot * 64 + i in slices of 2048 x 2048 texels.
const uint kPositionRow = 2048u;
const uint kPositionRowBits = 11u;
const uint kPositionSliceBits = 22u;
STRATA_SHARED_END
#ifdef __cplusplus
static_assert((1u << strata::shader::kPageSliceBits) - 1 == strata::shader::kPageSliceMask);
static_assert(strata::shader::kPageCellBits + strata::shader::kPageSliceBits == strata::shader::kPageChunkShift);
static_assert(strata::shader::kCellsPerSide * strata::shader::kTileTexels == 2048);
#else
ivec3 page_origin(uint page) {
  uint cell = page & kPageCellMask;
  return ivec3((cell % kCellsPerSide) * kTileTexels, (cell / kCellsPerSide) * kTileTexels,
               (page >> kPageCellBits) & kPageSliceMask);
}
#endif
