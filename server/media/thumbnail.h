#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/error.h"

namespace strata {

// Pixels that the picture's header may announce; more are refused before anything is decoded.
struct ThumbnailLimits {
  std::int64_t coarse = 200'000'000;  // of JPEGs, which come smaller than they are
  // where all must be in memory at once: all other formats, and progressive JPEG
  std::int64_t whole = 64'000'000;
};

// A JPEG of at most `largest_side` pixels a side of a picture, turned as its Exif data says,
// transparent places white. Every pixel is the mean of those it stands for. unsupported: neither of
// the formats; invalid: damaged, or too many pixels.
Result<std::vector<std::uint8_t>> make_thumbnail(std::span<const std::uint8_t> picture,
                                                 int largest_side, ThumbnailLimits limits = {});

}  // namespace strata
