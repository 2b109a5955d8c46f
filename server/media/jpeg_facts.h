#pragma once

#include <cstdint>
#include <span>

namespace strata {

// Facts from the segments before a JPEG's pixels. `orientation` is Exif's (1…8: from the stored
// rows to the picture as it was seen; 1 by default). A progressive picture must be decoded
// completely at any requested size. Adobe's programs mark their pictures, and store the inks of
// CMYK inverted: 255 is no ink.
struct JpegFacts {
  int orientation = 1;
  bool progressive = false;
  bool adobe = false;
};

// Never fails: damaged or truncated data give the defaults. Source: ITU-T T.81 annex B, Exif 2.3
// section 4.5.
JpegFacts read_jpeg_facts(std::span<const std::uint8_t> bytes);

}  // namespace strata
