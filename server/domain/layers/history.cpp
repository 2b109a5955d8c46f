#include "domain/layers/history.h"

namespace strata {

void TileResolver::add(const PastRevision& entry) {
  if (!is_open()) return;
  if (entry.writer && entry.in_force) {
    TileMask found;
    for (int w = 0; w < kMaskWords; ++w) {
      found.words[w] = open_.words[w] & entry.revision.written.words[w];
      open_.words[w] &= ~found.words[w];
      if (entry.provisional) provisional_.words[w] |= found.words[w];
    }
    copy_texels(past_, found, result_);
  }
  apply(entry.revision, past_);
}

TileData TileResolver::finish() && {
  copy_texels(past_, open_, result_);
  return std::move(result_);
}

}  // namespace strata
