#include "core/history.h"

#include <bit>

namespace strata {
namespace {

// Copies the texels of `mask` from one tile to another.
void copy_texels(const TileData& from, const TileMask& mask, TileData& to) {
  for (int w = 0; w < kMaskWords; ++w)
    for (std::uint64_t left = mask.words[w]; left; left &= left - 1) {
      const int texel = w * 64 + std::countr_zero(left);
      if (from.valid.test(texel))
        to.write(texel, from.bits(texel));
      else
        to.clear(texel);
    }
}

}  // namespace

TileData resolve_tile(const TileData& current, std::span<const PastRevision> newest_first, const TileMask& texels) {
  TileData result = current;
  TileData past = current;  // the tile after the revision at hand; walks back through history
  TileMask open = texels;   // texels whose author is not found yet
  for (const PastRevision& entry : newest_first) {
    if (!open.any()) return result;
    if (entry.writer && entry.in_force) {
      TileMask found;
      for (int w = 0; w < kMaskWords; ++w) {
        found.words[w] = open.words[w] & entry.revision.written.words[w];
        open.words[w] &= ~found.words[w];
      }
      if (found.any()) copy_texels(past, found, result);
    }
    apply(entry.revision, past);
  }
  copy_texels(past, open, result);
  return result;
}

}  // namespace strata
