#pragma once

#include <bit>

#include "domain/layers/tile.h"

namespace strata {

// Calls visit(texel) for each texel of the mask, in ascending order.
template <class Visit>
void for_each_texel(const TileMask& mask, Visit&& visit) {
  for (int w = 0; w < kMaskWords; ++w)
    for (std::uint64_t left = mask.words[w]; left != 0; left &= left - 1)
      visit(w * 64 + std::countr_zero(left));
}

}  // namespace strata
