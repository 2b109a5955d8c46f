#pragma once

#include <cstdint>
#include <span>

namespace strata {

// Facts from the segments before the pixels of a JPEG. `orientation` is the Exif number (1…8) of
// the rotation and mirroring from the stored rows to the upright image. The default is 1. A
// progressive image must be decoded completely at any requested size. Adobe programs mark their
// images, and store CMYK values inverted: 255 means 0 %.
struct JpegFacts {
  int orientation = 1;
  bool progressive = false;
  bool adobe = false;
};

// Never fails: returns the defaults for damaged or truncated data. Source: ITU-T T.81 annex B, Exif
// 2.3 section 4.5.
JpegFacts read_jpeg_facts(std::span<const std::uint8_t> bytes);

}  // namespace strata
