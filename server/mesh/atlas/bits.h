#pragma once

#include <algorithm>
#include <cstdint>

namespace strata::mesh {

// A row of texels is stored as bits, 64 per word. Returns the bits of [begin, end) in word number
// `word`.
inline std::uint64_t bits_between(int word, int begin, int end) {
  const int low = std::max(begin - 64 * word, 0), high = std::min(end - 64 * word, 64);
  if (low >= high) return 0;
  return (~std::uint64_t{0} << low) & (~std::uint64_t{0} >> (64 - high));
}

}  // namespace strata::mesh
