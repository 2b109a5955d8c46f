#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace strata::test {

// Images in formats that the server reads but does not write.

using Bytes = std::vector<std::uint8_t>;

struct TiffSettings {
  int bits = 8, samples = 3;
  std::uint16_t photometric = 2;    // PHOTOMETRIC_RGB
  std::uint16_t compression = 1;    // COMPRESSION_NONE
  std::uint16_t sample_format = 1;  // SAMPLEFORMAT_UINT
  bool tiled = false, big_endian = false, separate = false;
  int alpha = -1;  // kind of the last sample; −1: no extra sample
  int pages = 1;
  int orientation = 1;
  std::vector<std::uint16_t> palette;  // 3 × 2^bits values
};
// `sample(x, y, s)` returns a value in the range of `bits`. Pages after the first contain zeros.
Bytes tiff_of(int width, int height, const TiffSettings& settings,
              const std::function<std::uint32_t(int, int, int)>& sample);

Bytes webp_of(const Bytes& rgba, int width, int height);  // lossless
// `bits`: 8 (indices into a table of 256 colors, from the red channel), 24 or 32. `top_down`: the
// top row is first.
Bytes bmp_of(const Bytes& rgba, int width, int height, int bits, bool top_down = false);
// `bits`: 8 (gray, from the red channel), 24 or 32.
Bytes tga_of(const Bytes& rgba, int width, int height, int bits, bool packed);

enum class Inks { adobe_cmyk, adobe_ycck, plain_cmyk };
// Stores the colors of `rgba` as CMYK values of the given kind.
Bytes cmyk_jpeg_of(const Bytes& rgba, int width, int height, Inks inks);

}  // namespace strata::test
