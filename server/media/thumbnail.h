#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/error.h"

namespace strata {

// Limits of the pixels in a picture's header; larger pictures are refused before decoding.
struct ThumbnailLimits {
  std::int64_t coarse = 200'000'000;  // of JPEGs, which are reduced while decoding
  // of pictures that must be completely in memory: all other formats, and progressive JPEG
  std::int64_t whole = 64'000'000;
};

// Returns a JPEG of a picture with at most `largest_side` pixels per side, turned as its Exif data
// says, with transparent areas white. Every pixel is the mean of the pixels that it covers.
// unsupported: not one of the formats; invalid: damaged, or too many pixels.
Result<std::vector<std::uint8_t>> make_thumbnail(std::span<const std::uint8_t> picture,
                                                 int largest_side, ThumbnailLimits limits = {});

}  // namespace strata
