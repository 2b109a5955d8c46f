#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/error.h"

namespace strata {

// The largest numbers of pixels. Images with more pixels in their header are rejected before
// decoding.
struct ThumbnailLimits {
  std::int64_t coarse = 200'000'000;  // for JPEGs, which are reduced during decoding
  // For images that must be in memory as a whole: all other formats, and progressive JPEG.
  std::int64_t whole = 64'000'000;
};

// Returns a JPEG of an image with at most `largest_side` pixels per side. Applies the Exif
// orientation. Transparent areas become white. Each pixel is the mean of the pixels that it covers.
// Errors: `unsupported` for other formats; `invalid` for damaged images or too many pixels.
Result<std::vector<std::uint8_t>> make_thumbnail(std::span<const std::uint8_t> picture,
                                                 int largest_side, ThumbnailLimits limits = {});

}  // namespace strata
