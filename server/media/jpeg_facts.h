#pragma once

#include <cstdint>
#include <span>

namespace strata {

// Facts from the segments before the pixels of a JPEG. `orientation` is Exif's number for the turn
// and the mirroring from the stored rows to the upright image: 1…8, 1 by default. A progressive
// image must be decoded completely at any requested size. Adobe programs mark their images, and
// store CMYK values inverted: 255 means 0 %.
struct JpegFacts {
  int orientation = 1;
  bool progressive = false;
  bool adobe = false;
};

// Never fails: damaged or truncated data gives the defaults. Source: ITU-T T.81 annex B, Exif 2.3
// section 4.5.
JpegFacts read_jpeg_facts(std::span<const std::uint8_t> bytes);

}  // namespace strata
