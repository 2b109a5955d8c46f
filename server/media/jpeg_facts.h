#pragma once

#include <cstdint>
#include <span>

namespace strata {

// What stands before a JPEG's pixels. `orientation` is Exif's (1…8: how the stored rows lie to the
// picture as it was seen; 1 where nothing is said). A progressive picture is decoded as a whole,
// whatever size is asked for. Adobe's programs mark their pictures, and store the inks of those in
// CMYK inverted: 255 is no ink.
struct JpegFacts {
  int orientation = 1;
  bool progressive = false;
  bool adobe = false;
};

// Never fails: what is damaged or cut says nothing. Source: ITU-T T.81 annex B, Exif 2.3
// section 4.5.
JpegFacts read_jpeg_facts(std::span<const std::uint8_t> bytes);

}  // namespace strata
